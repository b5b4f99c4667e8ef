#!/usr/bin/env python3
"""The results of thermovox_benchmarks as tables in Markdown.

    tests/benchmark/tables.py RESULTS.json

Standard library only. Ratios are those that the run itself worked out, of rows measured next to each other.
"""
import json
import sys

WORKLOADS = {
    "carving/hall_0.1_m": "hall, 0.1 m, 8 scans",
    "carving/hall_0.05_m": "hall, 0.05 m, 4 scans",
    "carving/recorded_scan_0.1_m": "a real scan, 0.1 m",
    "surfaces/cold_hall_0.1_m": "hall, 0.1 m, 8 scans",
    "surfaces/warm_hall_0.1_m": "hall, 0.1 m, 200 scans",
    "surfaces/cold_hall_0.05_m": "hall, 0.05 m, 8 scans",
    "surfaces/warm_hall_0.05_m": "hall, 0.05 m, 200 scans",
}
ENGINES = {
    "carving": {
        "octomap": "OctoMap `insertPointCloud`",
        "openvdb": "OpenVDB, mask and one update a cell",
    },
    "surfaces": {
        "octomap": "OctoMap `updateNode`, lazy",
        "color_octomap": "ColorOcTree, lazy, `averageNodeColor`",
        "openvdb": "OpenVDB `FloatGrid` accessor",
        "block_floor": "floor: blocks that only add up",
    },
}


def rows_of(results, kind):
    """(workload, engine, counters) of every row of one kind."""
    for row in results["benchmarks"]:
        group, workload, engine = row["name"].split("/")[:3]
        if group == kind and not row.get("error_occurred"):
            yield f"{group}/{workload}", engine, row


def name_of(kind, engine):
    return ENGINES[kind].get(engine) or f"**{engine.replace('_', ' ')}**"


def three_digits(value):
    return f"{value:.3g}" if value < 1000 else f"{value:.0f}"


def ratio(row, peer):
    """How many times faster than the peer: in processor time and, in brackets, on the wall."""
    if f"times_{peer}" not in row:
        return ""
    return f"{three_digits(row[f'times_{peer}'])} ({three_digits(row[f'wall_times_{peer}'])})"


def print_table(head, rows):
    print("| " + " | ".join(head) + " |")
    print("| --- | --- " + "| ---: " * (len(head) - 2) + "|")
    for row in rows:
        print("| " + " | ".join(row) + " |")
    print()


def carving(results):
    print("All space between the laser and its returns freed:\n")
    head = ["workload", "engine", "thousand points a CPU-second", "x OctoMap (wall)", "x OpenVDB (wall)",
            "MB", "known cells, million", "bytes a known cell", "of these beyond 64 a surface cell"]
    print_table(head, ([
        WORKLOADS[workload], name_of("carving", engine), three_digits(row["points_per_cpu_s"] / 1e3),
        ratio(row, "octomap"), ratio(row, "openvdb"), f"{row['MB']:.0f}", f"{row['known_cells'] / 1e6:.2f}",
        f"{row['bytes_per_known_cell']:.1f}",
        f"{row['bytes_per_known_cell_without_64_a_surface']:.1f}" if "thermovox" in engine else "",
    ] for workload, engine, row in rows_of(results, "carving")))


def surfaces(results):
    print("Surfaces only (`--carve none`):\n")
    head = ["workload", "engine", "million points a CPU-second", "x OctoMap (wall)", "x floor (wall)", "MB",
            "surface cells, million", "bytes a surface cell"]
    print_table(head, ([
        WORKLOADS[workload], name_of("surfaces", engine), three_digits(row["points_per_cpu_s"] / 1e6),
        ratio(row, "octomap"), ratio(row, "block_floor"), f"{row['MB']:.0f}",
        f"{row['surface_cells'] / 1e6:.2f}", f"{row['bytes_per_surface_cell']:.0f}",
    ] for workload, engine, row in rows_of(results, "surfaces")))


def moved_object(results):
    rows = [row for row in results["benchmarks"] if row["name"].startswith("movedObject/")]
    if not rows:
        return
    print("A box that is taken away in the middle of a mission (hall, 0.1 m, 80 scans): true surface cells that "
          "are still occupied at its end, and false ones, at its end and after more missions:\n")
    head = ["`--carve`", "of true cells kept", "false cells", "left in the mission", "after the next mission",
            "after two"]
    print_table(head, ([
        row["name"].split("/")[1], f"{100 * row['true_cells_kept'] / row['true_cells']:.1f} %",
        f"{row['false_cells']:.0f}", f"{row['false_cells_left']:.0f}",
        f"{row['false_cells_left_after_the_next']:.0f}", f"{row['false_cells_left_after_two']:.0f}",
    ] for row in rows))


def station(results):
    """Speeds in bytes of the map as it lies in memory, from and to files in the page cache."""
    kinds = {"stationSave": "a new station is written", "stationLoad": "it is read"}
    rows = [(row["name"].split("/"), row) for row in results["benchmarks"]
            if row["name"].split("/")[0] in kinds and "map_MB" in row]
    if not rows:
        return
    print("Saving and loading (hall, 0.1 m), bytes of the map in memory by the clock on the wall:\n")
    print_table(["what", "threads", "map, MB", "file, MB", "MB/s"], ([
        kinds[name[0]], next((part.split(":")[1] for part in name if part.startswith("threads:")), "1"),
        f"{row['map_MB']:.0f}", f"{row['file_MB']:.1f}" if "file_MB" in row else "",
        f"{1e3 * row['map_MB'] / row['real_time']:.0f}",
    ] for name, row in rows))


def main(arguments):
    if len(arguments) != 1:
        raise SystemExit(__doc__)
    with open(arguments[0], encoding="utf-8") as file:
        results = json.load(file)
    carving(results)
    surfaces(results)
    moved_object(results)
    station(results)


if __name__ == "__main__":
    main(sys.argv[1:])

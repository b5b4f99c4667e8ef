#!/usr/bin/env python3
"""Maps missions of a 3D laser end to end at 0.05 m and prints what that took in Markdown.

    tests/benchmark/long_mission.py THERMOVOX WORK_FOLDER SECONDS[@MB]|MISSION...

A mission is a folder that is there, or as many seconds of simulated flight, made in WORK_FOLDER; @MB maps it
with so much --memory.
Reading the files, colouring, mapping and writing the station all count; simulating does not. Peak memory is
the largest resident set of the process. Standard library only.
"""
import csv
import functools
import json
import os
import pathlib
import subprocess
import sys
import time


def run(command):
    """(standard output, wall seconds, processor seconds, peak bytes) of a program that succeeds."""
    start = time.monotonic()
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        output = process.stdout.read()
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        raise SystemExit(f"long_mission.py: {' '.join(command)} ended with {process.returncode}")
    return output, time.monotonic() - start, usage.ru_utime + usage.ru_stime, 1024 * usage.ru_maxrss


@functools.cache
def simulated(thermovox, work, seconds):
    mission = work / f"cloud-{seconds}"
    run([thermovox, "simulate", str(mission), "--laser", "cloud", "--duration", seconds, "--seed", "1", "--force"])
    return mission


def sensor_seconds(mission):
    """From the first sweep to the end of the last."""
    with open(mission / "clouds.csv", newline="", encoding="utf-8") as file:
        stamps = [float(row["timestamp"]) for row in csv.DictReader(file)]
    return (stamps[-1] - stamps[0]) * len(stamps) / (len(stamps) - 1)


def row_of(thermovox, work, which):
    name, _, memory = which.partition("@")
    mission = simulated(thermovox, work, name) if name.isdigit() else pathlib.Path(name)
    station = work / f"{mission.name}.tvx"
    seconds = sensor_seconds(mission)
    station.unlink(missing_ok=True)
    output, wall, processor, peak = run(
        [thermovox, "map", str(mission), "--station", str(station), "--resolution", "0.05", "--json"]
        + (["--memory", memory] if memory else []))
    report = json.loads(output)
    points = report["points"]
    kept = f", `--memory {memory}`: {report['spilled_tiles']} times a tile did not fit" if memory else ""
    cells = [
        f"{mission.name}, {seconds:.0f} s, {report['readings']} sweeps{kept}", f"{points / 1e6:.2f}", f"{wall:.1f} s",
        f"{processor:.1f} s", f"{points / wall / 1e3:.0f}", f"{seconds / wall:.1f}", f"{seconds / processor:.1f}",
        f"{peak / 1e6:.0f} MB", f"{report['voxels'] / 1e6:.2f}", f"{station.stat().st_size / 1e6:.1f} MB",
    ]
    return "| " + " | ".join(cells) + " |"


def main(arguments):
    if len(arguments) < 3:
        raise SystemExit(__doc__)
    thermovox, work = arguments[0], pathlib.Path(arguments[1])
    work.mkdir(parents=True, exist_ok=True)
    print("Whole missions at 0.05 m, from files to a closed station:\n")
    print("| mission | million points | wall | processor | thousand points a second | x the sensor's time, wall "
          "| processor | peak memory | million surface cells | station |")
    print("| --- " + "| ---: " * 9 + "|")
    for which in arguments[2:]:
        print(row_of(thermovox, work, which), flush=True)
    print()


if __name__ == "__main__":
    main(sys.argv[1:])

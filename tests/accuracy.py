#!/usr/bin/env python3
"""How far a points record, or a map's cells exported as CSV, lies from the truth of its simulated mission, as
rows of a Markdown table.

    tests/accuracy.py LABEL POINTS.csv TRUTH.json [LABEL POINTS.csv TRUTH.json ...]

The truth of a point is the surface of the hall nearest to it: its distance is the error of the position, its
temperature (with the hot spots' excess) is what the point should have been given. Standard library only.
"""
import csv
import json
import math
import statistics
import sys

FLOOR_AND_CEILING, END_WALLS, SIDE_WALLS = 20.0, 21.0, 21.5  # Celsius
SURE = 0.3  # Celsius; points whose sigma is below count as sure of themselves


class Hall:
    """The scene that the simulator flew through, from its truth file."""

    def __init__(self, path):
        with open(path, encoding="utf-8") as file:
            truth = json.load(file)
        length, width, height = truth["size"]
        self.planes = [
            (0, -length / 2, END_WALLS), (0, length / 2, END_WALLS),
            (1, -width / 2, SIDE_WALLS), (1, width / 2, SIDE_WALLS),
            (2, 0.0, FLOOR_AND_CEILING), (2, height, FLOOR_AND_CEILING),
        ]
        self.boxes = truth["boxes"]
        self.cylinders = truth["cyls"]
        self.hot_spots = truth["hotspots"]

    def nearest(self, p):
        """Distance (m) to the nearest surface and the temperature (C) there."""
        distance, celsius = min(self._surfaces(p))
        return distance, celsius + self._excess(p)

    def _surfaces(self, p):
        for axis, value, celsius in self.planes:
            yield abs(p[axis] - value), celsius
        for low, high, celsius in self.boxes:
            yield box_distance(p, low, high), celsius
        for x, y, radius, top, celsius in self.cylinders:
            side = abs(math.hypot(p[0] - x, p[1] - y) - radius)
            yield math.hypot(side, max(p[2] - top, 0.0)), celsius

    def _excess(self, p):
        return sum(spot["delta"] * math.exp(-math.dist(p, spot["position"]) ** 2 / (2 * spot["sigma"] ** 2))
                   for spot in self.hot_spots)


def box_distance(p, low, high):
    """Distance (m) from p to the surface of a box, from outside or inside."""
    outside = math.dist(p, [min(max(c, a), b) for c, a, b in zip(p, low, high)])
    return outside or min(min(c - a, b - c) for c, a, b in zip(p, low, high))


def errors_of(points_path, hall):
    """(distance, temperature error, sigma) of every coloured point."""
    with open(points_path, newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            if row["temperature"] in ("", "nan"):
                continue
            distance, celsius = hall.nearest([float(row[axis]) for axis in "xyz"])
            yield distance, float(row["temperature"]) - celsius, float(row.get("sigma") or row["temperature_sigma"])


def rms(values):
    return math.sqrt(statistics.fmean(v * v for v in values))


def mean_and_rms(errors):
    if not errors:
        return "-"
    return f"{statistics.fmean(map(abs, errors)):.3f} / {rms(errors):.2f} °C"


def row_of(label, errors):
    if not errors:
        raise SystemExit(f"accuracy.py: {label}: no coloured points in the record")
    celsius = [error for _, error, _ in errors]
    sure = [error for _, error, sigma in errors if sigma < SURE]
    ratios = [abs(error) / sigma for _, error, sigma in errors]
    cells = [
        label, f"{len(errors)}", mean_and_rms(celsius),
        f"{len(sure) / len(errors):.0%}", mean_and_rms(sure),
        f"{sum(ratio <= 2 for ratio in ratios) / len(ratios):.1%}", f"{statistics.median(ratios):.2f}",
        f"{1000 * rms([distance for distance, _, _ in errors]):.1f} mm",
    ]
    return "| " + " | ".join(cells) + " |"


def main(arguments):
    if not arguments or len(arguments) % 3 != 0:
        raise SystemExit(__doc__)
    print("| laser | coloured | temperature: mean error / rms "
          f"| with sigma < {SURE} °C | of these: mean error / rms "
          "| errors within 2 sigma | median of error / sigma | position: rms to the surface |")
    print("| --- " + "| ---: " * 7 + "|")
    for label, points, truth in zip(arguments[::3], arguments[1::3], arguments[2::3]):
        print(row_of(label, list(errors_of(points, Hall(truth)))))


if __name__ == "__main__":
    main(sys.argv[1:])

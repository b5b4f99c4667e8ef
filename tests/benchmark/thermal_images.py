#!/usr/bin/env python3
"""Temperatures of radiometric JPEGs by thermovox, and by exiftool and NumPy, on the same files in one run.

    tests/benchmark/thermal_images.py BUILD FILE.jpg...

Prints a table in Markdown, milliseconds (the least of several runs): from a file's bytes to temperatures within
a program that is running, a whole process each (read the file, write float temperatures; most of ours is the
loading of libraries), and NumPy's part alone, the formula for every pixel. Files whose counts are stored raw.
BUILD is a build folder with the benchmarks.
Needs exiftool and NumPy.
"""
import json
import os
import subprocess
import sys
import tempfile
import time

import numpy as np

RUNS = 7


def least(work):
    """Milliseconds of the quickest of several runs, and the last result."""
    best, result = float("inf"), None
    for _ in range(RUNS):
        start = time.perf_counter()
        result = work()
        best = min(best, time.perf_counter() - start)
    return 1e3 * best, result


def number_of(value):
    """exiftool writes some numbers as text."""
    try:
        return float(value) if isinstance(value, str) else value
    except ValueError:
        return value


def by_exiftool(file):
    """Counts and parameters, as tools around exiftool get them: two calls."""
    raw = subprocess.run(["exiftool", "-b", "-RawThermalImage", file], check=True, capture_output=True).stdout
    tags = json.loads(subprocess.run(["exiftool", "-j", "-n", "-FLIR:all", file], check=True,
                                     capture_output=True).stdout)[0]
    tags = {key: number_of(value) for key, value in tags.items()}
    shape = (tags["RawThermalImageHeight"], tags["RawThermalImageWidth"])
    pixels = raw[-2 * shape[0] * shape[1]:]  # exiftool puts a TIFF header before raw counts
    return np.frombuffer(pixels, "<u2").reshape(shape).astype(np.float64), tags


def signal(tags, celsius):
    return tags["PlanckR1"] / (tags["PlanckR2"] * (np.exp(tags["PlanckB"] / (celsius + 273.15)) -
                                                   tags["PlanckF"])) - tags["PlanckO"]


def celsius(counts, tags):
    """The formula of io/README.md with the whole air before the lens."""
    t = tags["AtmosphericTemperature"]
    humidity = tags["RelativeHumidity"]
    humidity = humidity / 100 if humidity > 2 else humidity
    water = humidity * np.exp(1.5587 + 0.06939 * t - 0.00027816 * t**2 + 6.8455e-7 * t**3)
    root, x = np.sqrt(tags["ObjectDistance"]), tags["AtmosphericTransX"]
    tau = (x * np.exp(-root * (tags["AtmosphericTransAlpha1"] + tags["AtmosphericTransBeta1"] * np.sqrt(water))) +
           (1 - x) * np.exp(-root * (tags["AtmosphericTransAlpha2"] + tags["AtmosphericTransBeta2"] * np.sqrt(water))))
    e, w = tags["Emissivity"], tags["IRWindowTransmission"]
    seen = (counts / (e * tau * w) - (1 - tau) / (e * tau) * signal(tags, t) -
            (1 - w) / (e * w * tau) * signal(tags, tags["IRWindowTemperature"]) -
            (1 - e) / e * signal(tags, tags["ReflectedApparentTemperature"]))
    return tags["PlanckB"] / np.log(tags["PlanckR1"] / (tags["PlanckR2"] * (seen + tags["PlanckO"])) +
                                    tags["PlanckF"]) - 273.15


def by_thermovox(program, file, out):
    subprocess.run([program, "image", file, out, "--force"], check=True, capture_output=True)
    return out


def in_process(build, file):
    """Milliseconds from bytes to temperatures, the table of temperatures kept from image to image."""
    program = os.path.join(build, "tests/benchmark/thermovox_image_benchmarks")
    name = f"decode/{os.path.basename(file)}/warm"
    report = subprocess.run([program, f"--benchmark_filter=^{name}$", "--benchmark_format=json",
                             "--benchmark_repetitions=5", file], check=True, capture_output=True).stdout
    times = [run["real_time"] for run in json.loads(report)["benchmarks"] if run["run_type"] == "iteration"]
    return 1e-3 * min(times)


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    build, files = sys.argv[1], sys.argv[2:]
    program = os.path.join(build, "apps/thermovox")
    print("| file | size | thermovox, in process | thermovox, process | exiftool + NumPy | ratio to the process | "
          "ratio to in process | NumPy's formula alone | largest difference, C |")
    print("|" + " --- |" * 9)
    with tempfile.TemporaryDirectory() as folder:
        for file in files:
            out = os.path.join(folder, "out.tiff")
            ours, _ = least(lambda: by_thermovox(program, file, out))
            theirs, image = least(lambda: celsius(*by_exiftool(file)))
            alone, _ = least(lambda counts_tags=by_exiftool(file): celsius(*counts_tags))
            inside = in_process(build, file)
            with open(out, "rb") as tiff:
                written = np.frombuffer(tiff.read()[-4 * image.size:], "<f4").reshape(image.shape)
            print(f"| {os.path.basename(file)} | {image.shape[1]} x {image.shape[0]} | {inside:.3f} | {ours:.0f} | "
                  f"{theirs:.0f} | {theirs / ours:.1f} | {theirs / inside:.0f} | {alone:.2f} | {np.nanmax(np.abs(written - image)):.4f} |")


if __name__ == "__main__":
    main()

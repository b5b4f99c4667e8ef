#!/usr/bin/env python3
"""Temperatures of radiometric JPEGs by thermovox, and by exiftool and NumPy, on the same files in one run.

    tests/benchmark/thermal_images.py [--write] BUILD FILE.jpg...

Prints two tables in Markdown, the least of several runs. The first: microseconds from a file's bytes to
temperatures for every way of packing, with the table of temperatures known and with new parameters, and what
OpenCV (libpng) and charls need to unpack the same counts, without temperatures. The second, milliseconds, on the
files named, whose counts are stored raw: within a program that is running, a whole process each (read the file,
write float temperatures; most of ours is the loading of libraries), and NumPy's part alone, the formula for every
pixel. BUILD is a build folder with the benchmarks; --write puts the tables into io/README.md.
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


def benchmarks(build, pattern, *files):
    """Least microseconds of each benchmark whose name matches."""
    program = os.path.join(build, "tests/benchmark/thermovox_image_benchmarks")
    report = subprocess.run([program, f"--benchmark_filter={pattern}", "--benchmark_format=json",
                             "--benchmark_repetitions=5", *files], check=True, capture_output=True).stdout
    least_of = {}
    for run in json.loads(report)["benchmarks"]:
        if run["run_type"] == "iteration":
            least_of[run["run_name"]] = min(run["cpu_time"], least_of.get(run["run_name"], float("inf")))
    return least_of


def own_files(build):
    """What each way of packing costs, and what a peer needs to unpack the same counts."""
    times = benchmarks(build, "^(decode|peer)/(raw|png|jpeg_ls|tiff)_")
    yield "| counts, packed as | 160 x 120, us | new parameters, us | peer, us | 640 x 512, us | new parameters, us | peer, us |"
    yield "|" + " --- |" * 7
    peers = {"png": "OpenCV", "jpeg_ls": "charls"}
    for packing in ("raw", "tiff", "png", "jpeg_ls"):
        cells = [packing.replace("jpeg_ls", "JPEG-LS").replace("png", "PNG").replace("tiff", "TIFF")]
        for size in ("160x120", "640x512"):
            name = f"{packing}_{size}"
            cells += [f"{times[f'decode/{name}/warm']:.0f}", f"{times[f'decode/{name}/cold']:.0f}"]
            peer = times.get(f"peer/{name}")
            cells.append(f"{peer:.0f} ({peers[packing]})" if peer else "-")
        yield "| " + " | ".join(cells) + " |"


def recorded_files(build, files):
    """Ours against exiftool and NumPy, on files of cameras."""
    program = os.path.join(build, "apps/thermovox")
    yield ("| file | size | thermovox, in process | thermovox, process | exiftool + NumPy | ratio to the process | "
           "ratio to in process | NumPy's formula alone | largest difference, C |")
    yield "|" + " --- |" * 9
    with tempfile.TemporaryDirectory() as folder:
        for file in files:
            out = os.path.join(folder, "out.tiff")
            ours, _ = least(lambda: by_thermovox(program, file, out))
            theirs, image = least(lambda: celsius(*by_exiftool(file)))
            alone, _ = least(lambda counts_tags=by_exiftool(file): celsius(*counts_tags))
            name = f"decode/{os.path.basename(file)}/warm"
            inside = 1e-3 * benchmarks(build, f"^{name}$", file)[name]
            with open(out, "rb") as tiff:
                written = np.frombuffer(tiff.read()[-4 * image.size:], "<f4").reshape(image.shape)
            yield (f"| {os.path.basename(file)} | {image.shape[1]} x {image.shape[0]} | {inside:.3f} | {ours:.0f} | "
                   f"{theirs:.0f} | {theirs / ours:.1f} | {theirs / inside:.0f} | {alone:.2f} | "
                   f"{np.nanmax(np.abs(written - image)):.4f} |")


def machine():
    commit = subprocess.run(["git", "describe", "--always", "--dirty"], capture_output=True, text=True).stdout.strip()
    with open("/proc/cpuinfo", encoding="utf-8") as cpu:
        processor = next(line.split(": ")[1].strip() for line in cpu if line.startswith("model name"))
    return (f"Measured by `tests/benchmark/thermal_images.py` at {commit or 'no git'} on {processor}, load "
            f"{os.getloadavg()[0]:.2f}.")


def write_into(path, text):
    """Between the marks of a document."""
    with open(path, encoding="utf-8") as document:
        before, rest = document.read().split("<!-- images: begin -->\n")
    after = rest.split("<!-- images: end -->")[1]
    with open(path, "w", encoding="utf-8") as document:
        document.write(f"{before}<!-- images: begin -->\n{text}<!-- images: end -->{after}")


def main():
    arguments = sys.argv[1:]
    write = "--write" in arguments
    if write:
        arguments.remove("--write")
    if len(arguments) < 2:
        sys.exit(__doc__)
    build, files = arguments[0], arguments[1:]
    lines = [machine(), "", *own_files(build), "", *recorded_files(build, files)]
    text = "\n".join(lines) + "\n"
    print(text, end="")
    if write:
        write_into("io/README.md", text)


if __name__ == "__main__":
    main()

#!/bin/bash
# tables.py itself, on results that can be read by eye.
#   tests/benchmark/tables_test.sh WORK      WORK: a folder to write to
set -euo pipefail
script=$(realpath "$(dirname "$0")/tables.py")
mkdir -p "$1" && cd "$1"

cat > results.json << 'END'
{"benchmarks": [
 {"name": "carving/hall_0.1_m/octomap/iterations:1/manual_time", "points_per_cpu_s": 20000, "MB": 800,
  "known_cells": 14000000, "bytes_per_known_cell": 57.1, "bytes_per_known_cell_without_64_a_surface": 55},
 {"name": "carving/hall_0.1_m/thermovox/iterations:3/manual_time", "points_per_cpu_s": 1000000, "MB": 70,
  "known_cells": 14000000, "bytes_per_known_cell": 5.0, "bytes_per_known_cell_without_64_a_surface": 3.5,
  "times_octomap": 50, "wall_times_octomap": 48.4},
 {"name": "carving/recorded_scan_0.1_m/octomap/iterations:1/manual_time", "error_occurred": true},
 {"name": "surfaces/warm_hall_0.1_m/thermovox/iterations:3/manual_time", "points_per_cpu_s": 9000000, "MB": 90,
  "surface_cells": 1350000, "bytes_per_surface_cell": 66.7, "times_block_floor": 0.82, "wall_times_block_floor": 0.8}
]}
END
found=$(python3 "${script}" results.json | grep '^| hall\|^| a real')
# shellcheck disable=SC2016  # the backquotes are Markdown's
expected='| hall, 0.1 m, 8 scans | OctoMap `insertPointCloud` | 20 |  |  | 800 | 14.00 | 57.1 |  |
| hall, 0.1 m, 8 scans | **thermovox** | 1000 | 50 (48.4) |  | 70 | 14.00 | 5.0 | 3.5 |
| hall, 0.1 m, 200 scans | **thermovox** | 9 |  | 0.82 (0.8) | 90 | 1.35 | 67 |'
[ "${found}" = "${expected}" ] || {
  echo "expected"
  echo "${expected}"
  echo "found"
  echo "${found}"
  exit 1
}

#!/bin/bash
# Builds the benchmarks and measures the map against its peers, all in one run: tables in Markdown, and the
# curve of a map that grows. Needs some ten minutes and 3 GB of memory.
#   tests/benchmark/run.sh [--long] [--write] [BUILD]
# --long maps a mission of 600 s too (another ten minutes, 1 GB of disk); --write puts tables and picture into
# mapping/. BUILD is a build folder with the benchmarks (default: that of the preset release, built here).
set -euo pipefail
cd "$(dirname "$0")/../.."
# shellcheck source=.ci/packages.sh
source .ci/packages.sh

write=no
recordings=${THERMOVOX_DATA:-../shared/data}
missions=(6)
[ ! -d "${recordings}/missions/hall-cloud" ] || missions=("${recordings}/missions/hall-cloud" 6)
build=build/release
while [ $# -gt 0 ]; do
  case "$1" in
    --long) missions+=(600) ;;
    --write) write=yes ;;
    -*)
      sed -n '2,/^set /s/^# \{0,1\}//p' "$0" >&2
      exit 2
      ;;
    *) build=$1 ;;
  esac
  shift
done

if [ "${build}" = build/release ]; then
  install_packages build test
  cmake --preset release > /dev/null
  cmake --build "${build}" --target thermovox thermovox_benchmarks thermovox_growth -- --quiet
fi

work=build/benchmark
mkdir -p "${work}"
load_before=$(cut -d ' ' -f 1 /proc/loadavg)
"${build}/tests/benchmark/thermovox_benchmarks" --benchmark_filter='^(carving|surfaces|movedObject|stationSave|stationLoad)/' \
  --benchmark_out="${work}/results.json" --benchmark_out_format=json > "${work}/results.txt"
growth=$("${build}/tests/benchmark/thermovox_growth" "${work}/growth.csv" "${work}/growth.png")
tests/benchmark/long_mission.py "${build}/apps/thermovox" "${work}" "${missions[@]}" > "${work}/missions.md"

commit=$(git describe --always --dirty 2> /dev/null || echo "no git")
processor=$(sed -n 's/^model name[[:space:]]*: //p' /proc/cpuinfo | head -n 1)
{
  echo "Measured by \`tests/benchmark/run.sh\` at ${commit} on ${processor}, $(nproc) cores, load ${load_before}" \
    "before and $(cut -d ' ' -f 1 /proc/loadavg) after. Ratios are of this one run."
  echo
  python3 tests/benchmark/tables.py "${work}/results.json"
  echo "The hall at 0.1 m, all free space: ${growth}."
  echo
  echo "![Time and memory over the scans](growth.png)"
  echo
  cat "${work}/missions.md"
} > "${work}/tables.md"
cat "${work}/tables.md"

if [ "${write}" = yes ]; then
  sed -i -e '/^<!-- benchmark: begin/,/^<!-- benchmark: end/ {/^<!-- benchmark/!d}' \
    -e "/^<!-- benchmark: begin/r ${work}/tables.md" mapping/README.md
  cp "${work}/growth.png" mapping/growth.png
fi

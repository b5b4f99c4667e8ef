#!/bin/bash
# Measures the errors against simulated truth: flies one mission a laser kind through one hall, maps it in one
# pass, in two, and painted, compares every coloured point, and where painted every coloured cell, with the
# hall as it really is, and prints the table of the README.
#   tests/accuracy.sh [--write] [THERMOVOX]
# THERMOVOX is the program (default: that of tests/run.sh); --write puts the table into README.md.
set -euo pipefail
cd "$(dirname "$0")/.."

write=no
if [ "${1:-}" = --write ]; then
  write=yes
  shift
fi
thermovox=${1:-build/release/apps/thermovox}
if [ ! -x "${thermovox}" ]; then
  echo "accuracy.sh: no program at ${thermovox}; build it with tests/run.sh, or name another" >&2
  exit 1
fi

work=build/accuracy
rm -rf "${work}" && mkdir -p "${work}"
arguments=()
for laser in cloud scan beam; do
  mission=${work}/${laser}
  "${thermovox}" simulate "${mission}" --laser "${laser}" --seed 1 > /dev/null
  "${thermovox}" map "${mission}" --station "${mission}.tvx" --points "${mission}.csv" > /dev/null
  arguments+=("${laser}" "${mission}.csv" "${mission}.truth.json")
done

# again <label> <laser> <what is compared: points or cells> <options of map>: maps a mission once more.
again() {
  local label=$1 laser=$2 what=$3
  local mission=${work}/${laser}
  local name=${mission}.${label//[^a-z]/_}
  shift 3
  "${thermovox}" map "${mission}" --station "${name}.tvx" --points "${name}.points.csv" "$@" > /dev/null
  "${thermovox}" export "${name}.tvx" "${name}.cells.csv" > /dev/null
  arguments+=("${label}" "${name}.${what}.csv" "${mission}.truth.json")
}
"${thermovox}" export "${work}/cloud.tvx" "${work}/plant.ply" > /dev/null
again "scan, two passes" scan points --two-pass
again "beam, two passes, geometry of the cloud" beam points --two-pass --geometry "${work}/plant.ply"
again "scan, cells of the map" scan cells
again "scan, cells of the map, painted" scan cells --paint
again "beam, cells of the cloud's map, painted" beam cells --paint --geometry "${work}/plant.ply"
python3 tests/accuracy.py "${arguments[@]}" > "${work}/table.md"
cat "${work}/table.md"

if [ "${write}" = yes ]; then
  sed -i -e '/^<!-- accuracy: begin/,/^<!-- accuracy: end/ {/^<!-- accuracy/!d}' \
    -e "/^<!-- accuracy: begin/r ${work}/table.md" README.md
fi

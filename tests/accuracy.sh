#!/bin/bash
# Measures the errors against simulated truth: flies one mission a laser kind, maps it in one pass, compares
# every coloured point with the hall as it really is, and prints the table of the README.
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
python3 tests/accuracy.py "${arguments[@]}" > "${work}/table.md"
cat "${work}/table.md"

if [ "${write}" = yes ]; then
  sed -i -e '/^<!-- accuracy: begin/,/^<!-- accuracy: end/ {/^<!-- accuracy/!d}' \
    -e "/^<!-- accuracy: begin/r ${work}/table.md" README.md
fi

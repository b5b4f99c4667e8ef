#!/bin/bash
# Rules of the house that a formatter does not know. Prints every offence; exit code 1 if there is one.
#   tests/check_style.sh [ROOT]
set -euo pipefail
cd "${1:-$(dirname "$0")/..}"

folders=()
for folder in .ci apps calibration io mapping maps projection tests; do
  [ ! -d "${folder}" ] || folders+=("${folder}")
done
offences=0

# offence <rule>: counts and prints the lines on standard input as offences against a rule.
offence() {
  local line
  while IFS= read -r line; do
    echo "${line}: $1"
    offences=$((offences + 1))
  done
}

# Files of the project: the root's own, and those of its folders without what users and the demo put in maps/.
project_files() {
  find . -maxdepth 1 -type f ! -name '*.tvx*' ! -name compile_commands.json
  find "${folders[@]}" -type f ! -path 'maps/*' ! -path '*/__pycache__/*'
  [ ! -f maps/README.md ] || echo maps/README.md
}

mapfile -t files < <(project_files | sort)
# Golden data and pictures are taken as they are.
mapfile -t texts < <(printf '%s\n' "${files[@]}" | grep -v -E '^tests/(data|fuzz/(seeds|corpus))/|\.png$')
mapfile -t headers < <(printf '%s\n' "${texts[@]}" | grep '\.hpp$' || true)

lines_with() { grep -n -H -E "$1" "${texts[@]}" | cut -d: -f1,2 || true; }

offence "a tab (indent with spaces)" < <(lines_with $'\t')
offence "blanks at the end of a line" < <(lines_with ' +$')
offence "a path of somebody's own machine" < <(lines_with '(^|[^a-zA-Z0-9_.$}/-])/(home/[a-z]|root/|Users/[A-Za-z]|work/|mnt/[a-z])')
if [ "${#headers[@]}" -gt 0 ]; then
  offence "a header without #pragma once" < <(grep -L -x '#pragma once' "${headers[@]}" || true)
fi

# The top level is the user's view of the project: nothing comes to stand there unasked.
known_root='\.ci|\.clang-format|\.clang-tidy|\.gitignore|CHANGELOG\.md|CMakeLists\.txt|CMakePresets\.json|CONTRIBUTING\.md|LICENSE|README\.md'
known_folders='apps|calibration|io|mapping|maps|projection|tests'
ignored='\.git|build.*|\.cache|compile_commands\.json|.*\.tvx(-wal|-shm)?'
offence "does not belong on the top level" \
  < <(find . -mindepth 1 -maxdepth 1 -printf '%f\n' | grep -v -x -E "${known_root}|${known_folders}|${ignored}" || true)

if [ "${offences}" -gt 0 ]; then
  echo "check_style: ${offences} offences in ${#files[@]} files"
  exit 1
fi
echo "check_style: ${#files[@]} files, no offence"

#!/bin/bash
# The documents keep their word: the verbs of the README are those of the program, its example of a rig can be
# read, links lead somewhere, and the Python of maps/README.md reads what the program writes.
#   tests/readme_test.sh THERMOVOX WORK      WORK: a folder to write to; it is emptied
set -euo pipefail
cd "$(dirname "$0")/.."
thermovox=$(realpath "$1")
work=$2
failures=0

fail() {
  echo "$*"
  failures=$((failures + 1))
}

# block <document> <language> <number>: the text of one fenced block.
block() {
  awk -v begin="\`\`\`$2" -v wanted="$3" \
    '$0 == begin { n++; inside = 1; next } /^```/ { inside = 0 } inside && n == wanted' "$1"
}

verbs() {
  local documented offered
  documented=$(grep -o -E '^\| `thermovox [a-z]+' README.md | awk '{ print $3 }' | sort)
  offered=$("${thermovox}" --help | sed -n '/^Subcommands:/,$p' | awk '/^  [a-z]/ { print $1 }' | sort)
  [ "${documented}" = "${offered}" ] ||
    fail "README.md describes the verbs ${documented//$'\n'/ }, the program offers ${offered//$'\n'/ }"
}

# Every option of every verb is named; what all verbs share (--help, --force, --json, ...) once.
options() {
  local verb option
  for verb in $("${thermovox}" --help | sed -n '/^Subcommands:/,$p' | awk '/^  [a-z]/ { print $1 }'); do
    while IFS= read -r option; do
      [ "${option}" = --output ] && continue  # named as -o
      grep -q -E -e "${option}([^a-z-]|\$)" README.md || fail "README.md: does not name ${option} of ${verb}"
    done < <("${thermovox}" "${verb}" --help | grep -o -E '^  +(-[a-z], ?)?(-[a-z],)?--[a-z-]+' | grep -o -E -e '--[a-z-]+')
  done
}

rig() {
  block README.md yaml 1 > "${work}/rig.yaml"
  "${thermovox}" info "${work}/rig.yaml" > /dev/null || fail "README.md: its rig.yaml is refused"
}

links() {
  local document link
  for document in *.md */README.md; do
    while IFS= read -r link; do
      [ -e "$(dirname "${document}")/${link}" ] || fail "${document}: there is no ${link}"
    done < <(grep -o -E '\]\([^)#:]+\)' "${document}" | sed 's/^](\(.*\))$/\1/')
  done
}

python() {
  "${thermovox}" simulate "${work}/mission" --laser beam --duration 1 > /dev/null
  "${thermovox}" map "${work}/mission" --station "${work}/a.tvx" --points "${work}/points.csv" > /dev/null
  "${thermovox}" export "${work}/a.tvx" "${work}/map.ply" > /dev/null
  local number
  for number in 1 2; do
    block maps/README.md python "${number}" > "${work}/${number}.py"
    (cd "${work}" && python3 "${number}.py") > /dev/null || fail "maps/README.md: Python example ${number} fails"
  done
}

rm -rf "${work}" && mkdir -p "${work}"
verbs
options
rig
links
python
[ "${failures}" -eq 0 ]

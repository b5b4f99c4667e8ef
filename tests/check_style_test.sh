#!/bin/bash
# check_style.sh itself: a clean tree passes, every planted offence fails.
#   tests/check_style_test.sh WORK      WORK: a folder to plant in; it is emptied
set -euo pipefail
check=$(realpath "$(dirname "$0")/check_style.sh")
work=$1
failures=0

# expect <exit code> <what> <file> <its content, as for printf %b>
expect() {
  local code=0
  rm -rf "${work}" && mkdir -p "${work}/projection" "${work}/$(dirname "$3")"
  printf '#pragma once\n' > "${work}/projection/clean.hpp"
  printf '%b' "$4" > "${work}/$3"
  "${check}" "${work}" > "${work}.log" || code=$?
  if [ "${code}" -ne "$1" ] || { [ "${code}" -ne 0 ] && ! grep -q -F "${3%%/a.md}" "${work}.log"; }; then
    echo "$2: expected exit code $1, found ${code}:"
    cat "${work}.log"
    failures=$((failures + 1))
  fi
}

expect 0 "a clean source" projection/a.cpp '#include "projection/clean.hpp"\n'
expect 1 "a tab" projection/a.cpp 'int\tx;\n'
expect 1 "a blank at the end" io/a.cpp 'int x; \n'
expect 1 "a header that can be included twice" io/a.hpp 'int x;\n'
expect 1 "a path in a home folder" README.md 'see /'"home/somebody/data\n"
expect 0 "a system path" README.md 'see /usr/share/doc\n'
expect 1 "a folder nobody asked for" utils/a.md 'text\n'
expect 0 "what a user keeps in maps" maps/plant/points.csv 'a\tb\n'
expect 0 "a build folder" build/release/a.txt 'a\tb\n'
rm -rf "${work}" "${work}.log"
[ "${failures}" -eq 0 ]

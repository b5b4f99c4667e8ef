#!/bin/bash
# Runs every fuzz target, two at a time, each for an even share of the time; exit code 1 if one finds a fault.
#   tests/fuzz/run.sh SECONDS_IN_ALL [BUILD]     BUILD: a build with THERMOVOX_FUZZ, default build/asan-ubsan
# The seeds stay as they are; what a target finds on its way is dropped, a faulty input is kept in BUILD.
set -euo pipefail
cd "$(dirname "$0")/../.."

seconds="${1:?usage: tests/fuzz/run.sh SECONDS_IN_ALL [BUILD]}"
build="${2:-build/asan-ubsan}"
at_once=2

targets=()
for program in "${build}"/tests/fuzz/fuzz_*; do
  [ ! -f "${program}" ] || [ ! -x "${program}" ] || targets+=("${program}")
done
if [ "${#targets[@]}" -eq 0 ]; then
  echo "tests/fuzz/run.sh: no fuzz target in ${build}/tests/fuzz, expected a build with THERMOVOX_FUZZ" >&2
  exit 1
fi

rounds=$(((${#targets[@]} + at_once - 1) / at_once))
share=$((seconds / rounds > 0 ? seconds / rounds : 1))
work="$(mktemp -d)"
trap 'rm -rf "${work}"' EXIT

# fuzz <program>: new inputs go to a folder that is dropped, seeds are only read; leaves <name>.failed behind.
fuzz() {
  local name
  name="$(basename "$1")"
  mkdir "${work}/${name}"
  "$1" -max_total_time="${share}" -timeout=20 -rss_limit_mb=2048 -max_len=8192 -print_final_stats=1 \
    -artifact_prefix="${build}/tests/fuzz/${name}-" "${work}/${name}" "tests/fuzz/corpus/${name#fuzz_}" \
    > "${work}/${name}.log" 2>&1 || touch "${work}/${name}.failed"
}

running=0
for program in "${targets[@]}"; do
  if [ "${running}" -eq "${at_once}" ]; then
    wait -n
    running=$((running - 1))
  fi
  fuzz "${program}" &
  running=$((running + 1))
done
wait

status=0
for program in "${targets[@]}"; do
  name="$(basename "${program}")"
  if [ -e "${work}/${name}.failed" ]; then
    tail -n 40 "${work}/${name}.log"
    echo "${name}: FAILED within ${share} s"
    status=1
  else
    echo "${name}: $(sed -n 's/^stat::number_of_executed_units: *//p' "${work}/${name}.log") inputs in ${share} s"
  fi
done
exit "${status}"

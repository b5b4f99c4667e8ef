#!/bin/bash
# Installs what testing needs, builds, and runs every test.
#   tests/run.sh                the build that is shipped (warnings are errors) and all of its tests
#   tests/run.sh --sanitizers   the same tests under AddressSanitizer and UBSan, then the fuzz targets
#   tests/run.sh --lint         formatting, layers, style, scripts
# THERMOVOX_DATA names a folder of recordings; without it and without ../shared/data the tests that want a
# recording are skipped. The exit code is not 0 when anything failed.
set -euo pipefail
cd "$(dirname "$0")/.."
# shellcheck source=.ci/packages.sh
source .ci/packages.sh

fuzz_seconds=240
jobs=$(nproc)
started=${SECONDS}

say() { echo "== $* (${SECONDS} s)"; }

usage() {
  sed -n '2,/^set /s/^# \{0,1\}//p' "$0"
}

# A compiler cache that survives precompiled headers, wherever it may write.
use_ccache() {
  export CCACHE_SLOPPINESS=pch_defines,time_macros
  [ -w "${HOME:-/nonexistent}" ] || export CCACHE_DIR="${CCACHE_DIR:-${PWD}/build/ccache}"
}

build() { # <preset>
  say "configuring build/$1"
  cmake --preset "$1" > "build/$1.configure.log" 2>&1 || {
    cat "build/$1.configure.log" >&2
    return 1
  }
  say "building build/$1 with ${jobs} jobs"
  cmake --build "build/$1" --parallel "${jobs}" -- --quiet
}

run_ctest() { # <preset> [ctest's options]
  say "testing build/$1"
  ctest --test-dir "build/$1" --parallel "${jobs}" --no-tests=error --output-on-failure "${@:2}"
}

plain() {
  install_packages build test
  build release
  run_ctest release --progress
}

sanitizers() {
  install_packages build test sanitizers
  build asan-ubsan
  export ASAN_OPTIONS="${ASAN_OPTIONS:-detect_stack_use_after_return=1:strict_string_checks=1}"
  export UBSAN_OPTIONS="${UBSAN_OPTIONS:-print_stacktrace=1}"
  # Whole flights measured against the truth or OctoMap say nothing more about memory than the short ones, and
  # take most of the time; so do trials of the calibration. LeakSanitizer's tracer dies at the end of the search
  # for real boards.
  run_ctest asan-ubsan --progress --exclude-regex \
    '^(apps\.(Accuracy|HotspotTrials|Halls/TenMissions|Lasers/CalibrationTrials|SpoiledCaptures|Kinds/GivenCaptures)|mapping\.MissionParity|calibration\.(SelectCaptures\.Finds|FindChessboard\.FindsAll))'
  say "fuzzing for ${fuzz_seconds} s in all"
  tests/fuzz/run.sh "${fuzz_seconds}"
}

lint() {
  install_packages lint
  local -a sources scripts
  mapfile -t sources < <(find apps calibration io mapping projection tests -name '*.[hc]pp' | sort)
  mapfile -t scripts < <(find .ci apps tests -type f \( -name '*.sh' -o -path .ci/run \) | sort)
  local failed=no
  say "formatting of ${#sources[@]} sources"
  clang-format-14 --dry-run -Werror "${sources[@]}" || failed=yes
  say "${#scripts[@]} scripts"
  shellcheck --external-sources "${scripts[@]}" || failed=yes
  say "layers and style"
  cmake -DROOT="${PWD}" -P tests/check_layers.cmake || failed=yes
  tests/check_style.sh || failed=yes
  [ "${failed}" = no ]
}

mkdir -p build
use_ccache
case "${1:-}" in
  '') plain ;;
  --sanitizers) sanitizers ;;
  --lint) lint ;;
  --help | -h) usage && exit 0 ;;
  *) echo "tests/run.sh: unknown option $1" >&2 && usage >&2 && exit 2 ;;
esac
say "tests/run.sh ${1:-} passed in $((SECONDS - started)) s"

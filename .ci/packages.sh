#!/bin/bash
# The one place of package lists (Debian 12 names), and the function that installs what is missing.
# Source it from bash, or run it by hand:  .ci/packages.sh build test
# shellcheck disable=SC2034  # the lists are used by name

# What a user needs to build and run thermovox.
packages_build=(
  g++ cmake ninja-build
  libeigen3-dev libpcl-dev liboctomap-dev libopencv-dev
  libyaml-cpp-dev libtiff-dev libdeflate-dev libsqlite3-dev libzstd-dev
  libcli11-dev libspdlog-dev libfmt-dev nlohmann-json3-dev libboost-dev libceres-dev
)
# What the tests and benchmarks need besides. ccache and mold are used where they are found.
packages_test=(libgtest-dev libgmock-dev libbenchmark-dev libcharls-dev libbz2-dev libopenvdb-dev python3 sqlite3 ccache mold)
# Sanitizers and fuzz targets; llvm-14 has the symbolizer that gives their reports names and lines.
packages_sanitizers=(clang libclang-rt-14-dev llvm-14)
# Formatting, and the scripts' own checks.
packages_lint=(cmake clang-format-14 shellcheck)
# clang-tidy, for the preset `tidy` (by hand).
packages_tidy=(clang clang-tidy-14)
# What decoding of thermal images is compared with, by hand.
packages_peers=(libimage-exiftool-perl python3-numpy)
# To read LAS files with somebody else's reader; without them that test is skipped.
packages_readers=(nodejs npm)
# To print reports as PDF, and the letters they are meant in.
packages_report=(chromium fonts-liberation)
# Programs to look at results with: CloudCompare, octovis, PCL's viewer.
packages_view=(cloudcompare octovis pcl-tools)

# install_packages <purpose>...: installs the packages of these purposes that are missing; as root or with
# sudo. Costs nothing where all are there.
install_packages() {
  if ! command -v dpkg-query > /dev/null || ! command -v apt-get > /dev/null; then
    echo "packages.sh: this system has no apt; please install what the lists in .ci/packages.sh name ($*)" >&2
    echo "             by the means of your distribution; going on with what is there" >&2
    return 0
  fi
  local purpose package installed
  local -a wanted=() missing=()
  for purpose in "$@"; do
    if ! declare -p "packages_${purpose}" > /dev/null 2>&1; then
      echo "packages.sh: there is no list packages_${purpose}" >&2
      return 1
    fi
    local -n list="packages_${purpose}"
    wanted+=("${list[@]}")
    unset -n list
  done
  installed=$(dpkg-query --show --showformat='${db:Status-Status} ${Package}\n' "${wanted[@]}" 2> /dev/null || true)
  for package in "${wanted[@]}"; do
    grep -q -x -F "installed ${package}" <<< "${installed}" || missing+=("${package}")
  done
  [ "${#missing[@]}" -eq 0 ] || apt_install "${missing[@]}"
}

apt_install() {
  local -a as_root=(env)
  if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo > /dev/null; then
      echo "packages.sh: missing: $*" >&2
      echo "packages.sh: to install them this must run as root, or sudo must be there" >&2
      return 1
    fi
    as_root=(sudo env)
  fi
  local -a apt=("${as_root[@]}" DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout=900 -o Dpkg::Use-Pty=0 -y)
  echo "installing $# packages: $*"
  "${apt[@]}" -q=2 update < /dev/null &&
    "${apt[@]}" -q=2 install --no-install-recommends "$@" < /dev/null
}

if [ "${BASH_SOURCE[0]}" = "$0" ]; then
  set -euo pipefail
  install_packages "$@"
fi

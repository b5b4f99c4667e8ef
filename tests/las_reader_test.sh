#!/bin/bash
# A LAS file as an independent reader sees it: the npm package copc, which is installed into WORK. Exit code 77
# (the test is skipped) where there is no npm, or it cannot fetch the package.
#   tests/las_reader_test.sh THERMOVOX WORK      WORK: a folder to write to
set -euo pipefail
compare=$(realpath "$(dirname "$0")/io/las_points.mjs")
thermovox=$(realpath "$1")
package=copc@0.0.8

mkdir -p "$2" && cd "$2"
if ! command -v npm > /dev/null || ! command -v node > /dev/null; then
  echo "skipped: there is no npm here (packages: .ci/packages.sh readers)"
  exit 77
fi
if [ ! -d node_modules/copc ] && ! timeout 120 npm install --prefix . --no-audit --no-fund --ignore-scripts \
  --loglevel=error "${package}" > npm.log 2>&1; then
  echo "skipped: npm cannot fetch ${package}: $(tail -n 1 npm.log)"
  exit 77
fi

rm -rf mission mission.truth.json map.*
"${thermovox}" simulate mission --laser scan --duration 1 > /dev/null
"${thermovox}" map mission --station map.tvx --resolution 0.1 > /dev/null
"${thermovox}" export map.tvx map.las > /dev/null
"${thermovox}" export map.tvx map.csv > /dev/null
node "${compare}" map.las map.csv

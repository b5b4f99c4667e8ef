#!/bin/bash
# A report of fifty hot spots in a real browser, and as it is printed. Exit code 77 (the test is skipped) where
# there is no Chromium or no npm, or npm cannot fetch playwright-core, which is installed into WORK.
#   tests/report_browser_test.sh REPORTED_PLANT WORK      WORK: a folder to write to
set -euo pipefail
look=$(realpath "$(dirname "$0")/report_browser.mjs")
reported_plant=$(realpath "$1")
package=playwright-core@1.56.0

mkdir -p "$2" && cd "$2"
browser=$(command -v chromium || command -v chromium-browser || command -v google-chrome || true)
if [ -z "${browser}" ]; then
  echo "skipped: there is no Chromium here (packages: .ci/packages.sh report)"
  exit 77
fi
if ! command -v npm > /dev/null || ! command -v node > /dev/null; then
  echo "skipped: there is no npm here (packages: .ci/packages.sh readers)"
  exit 77
fi
if [ ! -d node_modules/playwright-core ] && ! timeout 120 npm install --prefix . --no-audit --no-fund \
  --ignore-scripts --loglevel=error "${package}" > npm.log 2>&1; then
  echo "skipped: npm cannot fetch ${package}: $(tail -n 1 npm.log)"
  exit 77
fi

"${reported_plant}" report.html report.pdf
cp "${look}" look.mjs # beside node_modules
node look.mjs "${browser}" report.html report.pdf

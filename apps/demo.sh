#!/bin/bash
# The whole way on a fresh Debian 12, as root or with sudo: installs what running needs, builds, flies a
# simulated mission through a hall, maps it and exports the map. Everything lands in maps/demo/; running it
# again replaces what it made.
set -euo pipefail
cd "$(dirname "$0")/.."
# shellcheck source=.ci/packages.sh
source .ci/packages.sh
exec < /dev/null

out=maps/demo
log=build/demo.log
thermovox=build/install/apps/thermovox

# step <what> <command>...: runs the command with its output in the log, whose end is shown if it fails.
step() {
  local since=${SECONDS}
  printf '%-52s' "$1"
  if ! "${@:2}" >> "${log}" 2>&1; then
    echo "failed; the end of ${log}:"
    tail -n 12 "${log}"
    exit 1
  fi
  echo "$((SECONDS - since)) s"
}

build() {
  cmake --preset install && cmake --build build/install --parallel "$(nproc)"
}

export_map() {
  local ending
  for ending in ply pcd bt ot png; do
    "${thermovox}" export "${out}/demo.tvx" "${out}/map.${ending}" || return
  done
}

clean() {
  mkdir -p "${out}" && cd "${out}" || return
  rm -rf hall hall.truth.json demo.tvx demo.tvx-wal demo.tvx-shm points.csv map.{ply,pcd,bt,ot,png}
}

mkdir -p build
: > "${log}"
step "1/5 installing what is missing" install_packages build
step "2/5 building (build/install, log: ${log})" build
(clean)
step "3/5 simulating a flight" "${thermovox}" simulate "${out}/hall" --laser cloud --duration 24
step "4/5 mapping it" "${thermovox}" map "${out}/hall" --station "${out}/demo.tvx" --points "${out}/points.csv"
step "5/5 exporting the map" export_map
cat << END
In ${out}/:
  hall/               what the instruments recorded; hall.truth.json: the hall as it really is
  demo.tvx            the station: the persistent map (thermovox info ${out}/demo.tvx)
  map.png             the map, coloured by temperature
  map.ply, map.pcd    a point a cell with temperature (CloudCompare, PCL viewer)
  map.bt, map.ot      OctoMap, occupancy and colour (octovis)
  points.csv          every laser point with its temperature
The formats: maps/README.md. The program: ${thermovox} --help
END

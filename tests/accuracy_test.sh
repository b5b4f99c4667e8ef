#!/bin/bash
# accuracy.py itself, on a hall and points whose errors can be seen by eye.
#   tests/accuracy_test.sh WORK      WORK: a folder to write to
set -euo pipefail
script=$(realpath "$(dirname "$0")/accuracy.py")
mkdir -p "$1" && cd "$1"

cat > truth.json << 'END'
{"size": [10, 8, 5], "boxes": [[[1, 1, 0], [2, 2, 3], 30]], "cyls": [[-2, 0, 0.5, 4, 40]],
 "hotspots": [{"position": [-1.5, 0, 2], "delta": 10, "sigma": 0.1, "peak": 50}]}
END
# On the floor, 1 cm off the box, 2 cm inside the cylinder opposite the hot spot, on the hot spot, not coloured.
cat > points.csv << 'END'
timestamp,x,y,z,range,u,v,temperature,sigma
0.000000000,3,-2,0,4,10,10,20.1,0.1
0.100000000,0.99,1.5,1,4,10,10,30.0,0.1
0.200000000,-2.48,0,2,4,10,10,39.7,0.1
0.300000000,-1.5,0,2,4,10,10,49.0,1.0
0.400000000,-1.5,0,2,4,,,,
END
expected='| made up | 4 | 0.350 / 0.52 °C | 75% | 0.133 / 0.18 °C | 75.0% | 1.00 | 11.2 mm |'

found=$(python3 "${script}" "made up" points.csv truth.json | tail -n 1)
[ "${found}" = "${expected}" ] || {
  echo "expected ${expected}"
  echo "found    ${found}"
  exit 1
}

#!/bin/bash
# Measures every builder on three scenes made here, beside Embree when the program was built with it.
# bench.sh PROGRAM OUTPUT_FOLDER
set -euo pipefail

program=$1
out=$2
mkdir -p "$out"
rivals=()
if dpkg-query -W -f='${db:Status-Status}' libembree-dev 2>/dev/null | grep -q '^installed$'; then rivals=(--rivals embree); fi
"$program" bench scene:atrium scene:organic scene:foliage --builders all --repeat 5 "${rivals[@]}" \
  --json "$out/bench.json" --csv "$out/bench.csv"
echo "The same numbers are in $out/bench.json and $out/bench.csv."

#!/bin/bash
# Measures every builder on all procedural scenes and on the meshes given, beside every rival that the program was built
# with; then the duel with Embree over the same inputs.
# bench.sh PROGRAM OUTPUT_FOLDER [MESH]...       CAMERAS=FILE: their cameras
set -euo pipefail

program=$1
out=$2
shift 2
mkdir -p "$out"
scenes=()
for scene in $("$program" scenes --json - | python3 -c 'import json,sys; print(*(s["id"] for s in json.load(sys.stdin)))'); do
  scenes+=("scene:$scene,triangles=110000")
done
cameras=()
if [ -n "${CAMERAS:-}" ]; then cameras=(--cameras "$CAMERAS"); fi
"$program" bench "${scenes[@]}" "$@" "${cameras[@]}" --builders all --modes robust,fast --rivals all \
  --size 512x512 --json "$out/bench.json" --csv "$out/bench.csv"
"$program" duel "$@" "${cameras[@]}" --procedural --json "$out/duel.json" --csv "$out/duel.csv" --markdown "$out/duel.md"
echo "The same numbers are in $out/bench.json, $out/bench.csv, $out/duel.json, $out/duel.csv and $out/duel.md."

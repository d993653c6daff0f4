#!/bin/bash
# The main job on a scene made on the spot: all builders compared, two pictures drawn.
# demo.sh PROGRAM OUTPUT_FOLDER
set -euo pipefail

program=$1
out=$2
scene=scene:atrium,triangles=20000
mkdir -p "$out"

echo
echo "== Every builder on $scene: build time, expected cost Exp(T), work per ray, speed =="
"$program" bench "$scene" --builders all --layouts wide8 --size 256x256 --repeat 2

"$program" render "$scene" --quiet --size 720x480 --shade ao -o "$out/atrium.png"
"$program" render "$scene" --quiet --size 720x480 --shade nodes -o "$out/atrium_nodes.png"

echo
echo "Done: every builder made a tree of the atrium's triangles (about 20,000) and traced the same rays through it (the table" \
  "above), and the view is in $out/atrium.png, with the nodes each pixel visited in $out/atrium_nodes.png; next try" \
  "your own mesh: $program bench YOUR_MESH.ply --builders all"

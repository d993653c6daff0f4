#!/usr/bin/env python3
"""How many times as fast calls with many rays are as single ones, by the size of a picture, as tables of Markdown.

    batches.py PROGRAM [--sizes 64,128,...] [--isas avx512,avx2] [--cameras FILE] [MESH or scene:NAME...]

Runs `boxwood bench` once for each input, size and instruction set: `balanced`, fast mode, one thread, both ways in turns.
"""

import argparse
import json
import os
import subprocess
import sys

SCENES = ["scene:atrium,triangles=250000", "scene:city,triangles=250000", "scene:organic,triangles=250000"]
KINDS = ["primary", "diffuse", "random", "occlusion"]


def ratios(options, scene, size, isa):
    command = [options.program, "bench", scene, "--builders", "balanced", "--modes", "fast", "--traversals", "single,batch",
               "--rays", ",".join(KINDS), "--size", f"{size}x{size}", "--repeat", "15" if size <= 256 else "5",
               "--threads", "1", "--quiet", "--json", "-"]
    if options.cameras:
        command += ["--cameras", options.cameras]
    done = subprocess.run(command, capture_output=True, text=True, env=dict(os.environ, BOXWOOD_ISA=isa))
    if done.returncode != 0:
        sys.exit(f"batches.py: {' '.join(command)}: {done.stderr.strip()}")
    rays = {}
    for row in json.loads(done.stdout)["rows"]:
        rays.setdefault(row["rays"], {})[row["traversal"]] = row["mrays"]["median"]
    return {kind: rays[kind]["batch"] / rays[kind]["single"] for kind in KINDS if kind in rays}


def table(heads, rows):
    lines = [heads, ["---"] + ["---:"] * (len(heads) - 1), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def cell(values, kind):
    return f"{values[kind]:.2f}" if kind in values else "-"


def main():
    parser = argparse.ArgumentParser(description="Calls with many rays over single calls")
    parser.add_argument("program")
    parser.add_argument("scenes", nargs="*", default=SCENES)
    parser.add_argument("--sizes", default="64,128,256,512,1024")
    parser.add_argument("--isas", default="avx512,avx2")
    parser.add_argument("--cameras")
    options = parser.parse_intermixed_args()
    sizes = [int(size) for size in options.sizes.split(",")]
    for isa in options.isas.split(","):
        found = {(scene, size): ratios(options, scene, size, isa) for scene in options.scenes for size in sizes}
        names = {scene: scene.removeprefix("scene:").split(",")[0].split("/")[-1] for scene in options.scenes}
        print(f"\n**{isa}, camera rays, by the picture's side**\n")
        print(table(["scene", *map(str, sizes)],
                    [[names[s], *(cell(found[s, size], "primary") for size in sizes)] for s in options.scenes]))
        print(f"\n**{isa}, scattered rays in the picture's order, {sizes[0]} and {sizes[-1]}**\n")
        print(table(["scene", *(f"{kind}, {size}" for kind in KINDS[1:] for size in (sizes[0], sizes[-1]))],
                    [[names[s], *(cell(found[s, size], kind) for kind in KINDS[1:] for size in (sizes[0], sizes[-1]))]
                     for s in options.scenes]))


if __name__ == "__main__":
    main()

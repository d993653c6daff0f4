#!/usr/bin/env python3
"""Cost per ray, bytes and build speed against the size of a scene, ours beside Embree, as one table of Markdown.

    scaling.py PROGRAM [--scene organic] [--sizes 1000,10000,...] [--builder ID] [--rivals embree:medium] [--json FILE]

Runs `boxwood bench` once for each size, with one thread and with all. A size that does not fit (time or memory) is
left out by giving fewer --sizes.
"""

import argparse
import json
import subprocess
import sys


def measure(program, scene, triangles, options):
    command = [program, "bench", f"scene:{scene},triangles={triangles}", "--builders", options.builder, "--modes", "fast",
               "--rays", options.rays, "--size", options.size, "--repeat", str(options.repeat), "--quiet", "--json", "-"]
    if options.rivals:
        command += ["--rivals", options.rivals]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"scaling.py: {' '.join(command)}: {done.stderr.strip()}")
    report = json.loads(done.stdout)
    return report


def lines_of(report):
    """One line for each contestant and number of threads."""
    lines = {}
    for row in report["rows"]:
        line = lines.setdefault((row["builder"], row["threads"]), {
            "triangles": row["triangles"], "builder": row["builder"], "threads": row["threads"],
            "mtri": row["triangles"] / row["build_ms"] / 1e3, "bytes": row["bytes"] / row["triangles"], "ns": {}})
        line["ns"][row["rays"]] = 1e3 / row["mrays"]["median"]
    return list(lines.values())


def table(lines, kinds):
    heads = ["triangles", "tree", "threads", "build, Mtriangles/s", "bytes/triangle"]
    heads += [f"{kind}, ns/ray" for kind in kinds]
    rows = [heads, ["---:", "---", "---:"] + ["---:"] * (len(heads) - 3)]
    for line in lines:
        rows.append([f"{line['triangles']:,}", f"`{line['builder']}`", str(line["threads"]), f"{line['mtri']:.2f}",
                     f"{line['bytes']:.0f}"] + [f"{line['ns'][kind]:.0f}" for kind in kinds])
    return "\n".join("| " + " | ".join(row) + " |" for row in rows)


def main():
    parser = argparse.ArgumentParser(description="Cost per ray and bytes against size")
    parser.add_argument("program")
    parser.add_argument("--scene", default="organic")
    parser.add_argument("--sizes", default="1000,10000,100000,1000000,10000000")
    parser.add_argument("--builder", default="binned-sah")
    parser.add_argument("--rivals", default="")
    parser.add_argument("--rays", default="primary,random,occlusion")
    parser.add_argument("--size", default="512x512")
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--json", help="also every line as JSON to this file")
    options = parser.parse_args()
    lines = []
    for size in options.sizes.split(","):
        report = measure(options.program, options.scene, int(size), options)
        lines += lines_of(report)
        print(f"{options.scene} {int(size):,}: done", file=sys.stderr)
    print(table(lines, options.rays.split(",")))
    if options.json:
        with open(options.json, "w") as file:
            json.dump(lines, file, indent=1)


if __name__ == "__main__":
    main()

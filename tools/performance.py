#!/usr/bin/env python3
"""Measures, and pastes the tables into docs/performance.md and docs/batches.md between their markers.

    performance.py PROGRAM [--only duel,duel-again,ablation,scaling,roofline,batches] [--cameras FILE] [--document FILE] [MESH...]

`duel` and `duel-again` are the same command, so that both runs' spread is seen. Each takes minutes; leave the machine
alone meanwhile.
"""

import argparse
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
ABLATED = ["scene:atrium,triangles=250000", "scene:organic,triangles=250000", "scene:foliage,triangles=250000"]
PROCEDURAL = ["scene:city,triangles=250000", "scene:organic,triangles=250000"]


def output_of(command):
    print(" ".join(map(str, command)), file=sys.stderr)
    done = subprocess.run([str(word) for word in command], stdout=subprocess.PIPE, text=True)
    if done.returncode != 0:
        sys.exit(f"performance.py: {command[1]} failed")
    return done.stdout


def commands(options):
    cameras = ["--cameras", options.cameras] if options.cameras else []
    duel = [options.program, "duel", *options.meshes, "--procedural", *cameras, "--quiet", "--markdown", "-"]
    return {
        "duel": duel,
        "duel-again": duel,
        "ablation": [options.program, "ablate", *options.meshes, *ABLATED, *cameras, "--quiet", "--markdown", "-"],
        "scaling": [ROOT / "tools/scaling.py", options.program, "--rivals", "embree:medium", "--builder", "balanced"],
        "roofline": [ROOT / "tools/roofline.py", options.program],
        "batches": [ROOT / "tools/batches.py", options.program, *options.meshes, *PROCEDURAL, *cameras],
    }


def paste(document, name, text):
    begin, end = f"<!-- {name}:begin -->", f"<!-- {name}:end -->"
    content = document.read_text()
    head, rest = content.split(begin)
    document.write_text(head + begin + "\n" + text.strip() + "\n" + end + rest.split(end, 1)[1])


def main():
    parser = argparse.ArgumentParser(description="Bring the tables of docs/performance.md up to date")
    parser.add_argument("program")
    parser.add_argument("meshes", nargs="*")
    parser.add_argument("--only", default="duel,duel-again,ablation,scaling,roofline,batches")
    parser.add_argument("--cameras")
    parser.add_argument("--document", type=pathlib.Path, help="default: the page that the tables belong to")
    options = parser.parse_intermixed_args()  # meshes may stand behind options
    known = commands(options)
    for name in options.only.split(","):
        if name not in known:
            sys.exit(f"performance.py: there is no '{name}'; there are {', '.join(known)}")
    for name in options.only.split(","):
        page = ROOT / ("docs/batches.md" if name == "batches" else "docs/performance.md")
        paste(options.document or page, name, output_of(known[name]))


if __name__ == "__main__":
    main()

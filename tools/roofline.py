#!/usr/bin/env python3
"""What a node visit and a triangle test cost, in time and in instructions, as a table of Markdown.

    roofline.py PROGRAM [INPUT...] [--layout wide8] [--isa avx2] [--builders a,b,...]

Random rays through the trees of several builders over several scenes visit different numbers of nodes and test different
numbers of triangles; least squares over all of them split the cost of a ray into that of its start, of a node and of a triangle.
Time is `boxwood bench`'s, with one thread. Instructions are callgrind's, of `boxwood trace` with two numbers of rays, the
difference of which is what the rays alone take (reading and writing a ray included). The clock is that of a chain of
additions, which take a cycle each.
"""

import argparse
import json
import os
import pathlib
import random
import re
import struct
import subprocess
import sys
import tempfile

CLOCK = r"""
#include <stdio.h>
#include <time.h>
int main() {
  struct timespec a, b;
  unsigned long x = 1, n = 40000000;
  clock_gettime(CLOCK_MONOTONIC, &a);
  for (unsigned long i = 0; i < n; i += 8)
    __asm__ volatile("add $1, %0\nadd $1, %0\nadd $1, %0\nadd $1, %0\nadd $1, %0\nadd $1, %0\nadd $1, %0\nadd $1, %0" : "+r"(x));
  clock_gettime(CLOCK_MONOTONIC, &b);
  printf("%f\n", n / ((b.tv_sec - a.tv_sec) * 1e9 + (b.tv_nsec - a.tv_nsec)));
}
"""


# Highway's library asks for the clock's resolution by an instruction that valgrind does not know.
NO_TIMER = "unsigned long _ZN3hwy8platform15TimerResolutionEv(void) { return 1; }\n"


def run(command, environment):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, env=environment)
    if done.returncode != 0:
        sys.exit(f"roofline.py: {' '.join(map(str, command))}: {done.stderr.strip()}")
    return done


def clock_of(folder):
    """Cycles in a nanosecond."""
    (folder / "clock.c").write_text(CLOCK)
    run(["cc", "-O1", folder / "clock.c", "-o", folder / "clock"], None)
    return max(float(run([folder / "clock"], None).stdout) for _ in range(30))


def environment_for_valgrind(folder, environment):
    (folder / "timer.c").write_text(NO_TIMER)
    run(["cc", "-shared", "-fPIC", folder / "timer.c", "-o", folder / "timer.so"], None)
    return {**environment, "LD_PRELOAD": str(folder / "timer.so")}


def write_rays(path, bounds, count):
    """The same kind as bench's random rays: anywhere in the box, any direction."""
    generator = random.Random(1)
    header = f"{{'descr': '<f4', 'fortran_order': False, 'shape': ({count}, 6), }}"
    header += " " * (-(10 + len(header) + 1) % 64) + "\n"
    rays = bytearray()
    for _ in range(count):
        origin = [generator.uniform(low, high) for low, high in zip(bounds["lower"], bounds["upper"])]
        rays += struct.pack("<6f", *origin, *[generator.gauss(0, 1) for _ in range(3)])
    path.write_bytes(b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header.encode() + bytes(rays))


def instructions(program, options, text, builder, rays, folder, environment):
    command = ["valgrind", "--tool=callgrind", f"--callgrind-out-file={folder / 'callgrind.out'}", program, "trace",
               text, "--rays", rays, "-o", folder / "hits.npy", "--builder", builder, "--layout", options.layout,
               "--mode", "fast", "--threads", "1", "--quiet"]
    return int(re.search(r"Collected : (\d+)", run(command, environment).stderr).group(1))


def least_squares(rows, values):
    """x with rows x = values, by the normal equations."""
    n = len(rows[0])
    matrix = [[sum(row[i] * row[j] for row in rows) for j in range(n)] + [sum(r[i] * v for r, v in zip(rows, values))]
              for i in range(n)]
    for i in range(n):
        pivot = max(range(i, n), key=lambda k: abs(matrix[k][i]))
        matrix[i], matrix[pivot] = matrix[pivot], matrix[i]
        for k in range(n):
            if k != i:
                factor = matrix[k][i] / matrix[i][i]
                matrix[k] = [a - factor * b for a, b in zip(matrix[k], matrix[i])]
    return [matrix[i][n] / matrix[i][i] for i in range(n)]


def measure(text, options, folder, clock, environment, for_valgrind):
    """Scene, builder, nodes, triangles, cycles and instructions a ray, for each builder."""
    bounds = json.loads(run([options.program, "info", text, "--json", "-"], None).stdout)["bounds"]
    report = json.loads(run([options.program, "bench", text, "--builders", options.builders, "--layouts", options.layout,
                             "--modes", "fast", "--rays", "random", "--random-rays", 200000, "--size", "64x64",
                             "--repeat", 5, "--threads", 1, "--json", "-"], environment).stdout)
    write_rays(folder / "few.npy", bounds, options.rays)
    write_rays(folder / "many.npy", bounds, 2 * options.rays)
    for row in report["rows"]:
        few, many = (instructions(options.program, options, text, row["builder"], folder / f"{which}.npy", folder,
                                  for_valgrind) for which in ("few", "many"))
        yield (row["scene"], row["builder"], row["nodes_per_ray"], row["primitives_per_ray"],
               clock * 1e3 / row["mrays"]["median"], (many - few) / options.rays)


def main():
    parser = argparse.ArgumentParser(description="Cost of a node visit and of a triangle test")
    parser.add_argument("program")
    parser.add_argument("inputs", nargs="*")
    parser.add_argument("--layout", default="wide8")
    parser.add_argument("--isa", default="avx2")
    parser.add_argument("--builders", default="binned-sah,lbvh,equal-counts")
    parser.add_argument("--rays", type=int, default=10000)
    options = parser.parse_args()
    inputs = options.inputs or [f"scene:{scene},triangles=50000" for scene in ("organic", "atrium", "foliage", "city")]
    environment = {**os.environ, "BOXWOOD_ISA": options.isa}
    lines = []
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        clock = clock_of(folder)
        for_valgrind = environment_for_valgrind(folder, environment)
        for text in inputs:
            lines += measure(text, options, folder, clock, environment, for_valgrind)
    print(f"`{options.layout}`, {options.isa}, random rays, fast mode; {clock:.2f} cycles a nanosecond.\n")
    print("| scene | builder | nodes/ray | triangles/ray | cycles/ray | instructions/ray | instructions/cycle |")
    print("| --- | --- | ---: | ---: | ---: | ---: | ---: |")
    for scene, builder, nodes, triangles, cycles, count in lines:
        print(f"| {scene} | `{builder}` | {nodes:.2f} | {triangles:.2f} | {cycles:.0f} | {count:.0f} | "
              f"{count / cycles:.2f} |")
    rows = [(1, nodes, triangles) for _, _, nodes, triangles, _, _ in lines]
    for what, column in (("cycles", 4), ("instructions", 5)):
        start, node, triangle = least_squares(rows, [line[column] for line in lines])
        print(f"| least squares | {what} | {node:.1f} a node | {triangle:.1f} a triangle | {start:.0f} a ray | | |")


if __name__ == "__main__":
    main()

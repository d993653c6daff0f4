"""What the tests of the command line share: running the program, small meshes, NumPy files by hand."""

import json
import os
import pathlib
import re
import shutil
import struct
import subprocess
import tempfile
import unittest

PROGRAM = os.environ["BOXWOOD_PROGRAM"]
INSTRUMENTED = "BOXWOOD_INSTRUMENTED" in os.environ  # slow to start
MISS = 4294967295

CUBE_VERTICES = [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
CUBE_TRIANGLES = [(0, 2, 1), (1, 2, 3), (4, 5, 6), (5, 7, 6), (0, 1, 4), (1, 5, 4),
                  (2, 6, 3), (3, 6, 7), (0, 4, 2), (2, 4, 6), (1, 3, 5), (3, 7, 5)]


def write_ply(path, vertices, triangles):
    lines = ["ply", "format ascii 1.0", f"element vertex {len(vertices)}", "property float x", "property float y",
             "property float z", f"element face {len(triangles)}", "property list uchar int vertex_indices",
             "end_header"]
    lines += [" ".join(map(str, v)) for v in vertices]
    lines += ["3 " + " ".join(map(str, t)) for t in triangles]
    path.write_text("\n".join(lines) + "\n")
    return path


def write_npy(path, rows, columns, dtype="<f4"):
    header = f"{{'descr': '{dtype}', 'fortran_order': False, 'shape': ({len(rows)}, {columns}), }}"
    header += " " * (-(10 + len(header) + 1) % 64) + "\n"
    data = b"".join(struct.pack(f"<{columns}f", *row) for row in rows)
    path.write_bytes(b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header.encode() + data)
    return path


def read_npy(path):
    """The header as a dictionary and the raw data."""
    raw = path.read_bytes()
    assert raw[:8] == b"\x93NUMPY\x01\x00", raw[:8]
    (length,) = struct.unpack("<H", raw[8:10])
    header = eval(raw[10:10 + length].decode(), {"__builtins__": {}})  # a literal, as the format has it
    return header, raw[10 + length:]


def read_hits(path):
    header, data = read_npy(path)
    assert header["descr"] == [("t", "<f4"), ("u", "<f4"), ("v", "<f4"), ("primitive", "<u4")], header
    hits = list(struct.iter_unpack("<fffI", data))
    assert header["shape"] == (len(hits),), header
    return hits


def read_bools(path):
    header, data = read_npy(path)
    assert header["descr"] in ("|b1", "?"), header
    assert header["shape"] == (len(data),), header
    assert set(data) <= {0, 1}
    return [bool(b) for b in data]


class CommandLineTest(unittest.TestCase):
    maxDiff = None

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="boxwood_command_line_"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        self.cube = write_ply(self.folder / "cube.ply", CUBE_VERTICES, CUBE_TRIANGLES)

    def run_program(self, *arguments, code=0, environment=None):
        done = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, timeout=240,
                              cwd=self.folder, env={**os.environ, **(environment or {})})
        self.assertEqual(done.returncode, code, f"{arguments}\n{done.stdout}\n{done.stderr}")
        return done

    def report(self, *arguments, environment=None):
        """Runs with --json - and gives the report; nothing else may be on standard output."""
        done = self.run_program(*arguments, "--json", "-", environment=environment)
        return json.loads(done.stdout)

    def refused(self, *arguments, code=1, says=(), environment=None):
        """The run must fail with one line on standard error that holds each text of `says`."""
        done = self.run_program(*arguments, code=code, environment=environment)
        lines = done.stderr.splitlines()
        self.assertEqual(len(lines), 1, done.stderr)
        self.assertRegex(lines[0], r"^boxwood: \S")
        for text in [says] if isinstance(says, str) else says:
            self.assertIn(text, lines[0])
        return lines[0]

    def assert_environment(self, report, command):
        """The keys that every report starts with."""
        self.assertEqual(report["command"], command)
        self.assertRegex(report["version"], r"^\d+\.\d+\.\d+$")
        self.assertRegex(report["compiler"], r"^(GCC|Clang) \d+")
        self.assertGreaterEqual(report["threads"], 1)

    def assert_hash(self, text):
        self.assertTrue(re.fullmatch(r"[0-9a-f]{16}", text), text)

"""boxwood trace: NumPy rays in, NumPy hits out."""

import math
import unittest

from support import CUBE_TRIANGLES, CUBE_VERTICES, MISS, CommandLineTest, read_bools, read_hits, write_npy

RAYS = [
    (0.3, 0.4, -2, 0, 0, 1),      # front, t = 2
    (0.3, 0.4, -2, 0, 0, 4),      # the same, longer direction: t = 0.5
    (0.3, 0.4, 0.5, 0, 0, 1),     # from inside, t = 0.5
    (0.3, 0.4, -2, 0, 0, -1),     # away
    (3, 3, -2, 0, 0, 1),          # beside
]
LIMITED = [RAYS[0] + (0, 1.5), RAYS[0] + (0, 2.5), RAYS[0] + (2.5, math.inf), RAYS[0] + (3.5, math.inf)]


class Trace(CommandLineTest):
    def trace(self, rays, columns, *options):
        path = write_npy(self.folder / "rays.npy", rays, columns)
        return self.report("trace", self.cube, "--rays", path, "-o", self.folder / "hits.npy", *options)

    def test_closest_hits(self):
        report = self.trace(RAYS, 6)
        self.assert_environment(report, "trace")
        self.assertEqual((report["rays"], report["hits"]), (5, 3))
        self.assert_hash(report["ray_hash"])
        hits = read_hits(self.folder / "hits.npy")
        self.assertEqual([hit[0] for hit in hits], [2, 0.5, 0.5, math.inf, math.inf])
        self.assertEqual([hit[3] in (0, 1) for hit in hits[:2]], [True, True])
        self.assertIn(hits[2][3], (2, 3))
        self.assertEqual([hit[3] for hit in hits[3:]], [MISS, MISS])

    def test_limits(self):
        self.trace(LIMITED, 8)
        self.assertEqual([hit[0] for hit in read_hits(self.folder / "hits.npy")], [math.inf, 2, 3, math.inf])

    def test_any_hit(self):
        self.trace(LIMITED, 8, "--query", "any")
        self.assertEqual(read_bools(self.folder / "hits.npy"), [False, True, True, False])

    def test_every_layout_mode_and_builder_gives_the_same(self):
        answers = set()
        for layout in ("linear", "wide4", "wide8", "wide8-quads", "wide16"):
            for mode in ("robust", "fast"):
                for builder in ("middle", "sweep-sah", "hlbvh"):
                    self.trace(RAYS, 6, "--layout", layout, "--mode", mode, "--builder", builder)
                    answers.add(tuple((t, primitive) for t, _, _, primitive in read_hits(self.folder / "hits.npy")))
        self.assertEqual(len(answers), 1)

    def test_the_hit_point_is_on_the_triangle(self):
        self.trace(RAYS, 6)
        for ray, (t, u, v, primitive) in zip(RAYS, read_hits(self.folder / "hits.npy")):
            if primitive == MISS:
                continue
            a, b, c = (CUBE_VERTICES[i] for i in CUBE_TRIANGLES[primitive])
            for axis in range(3):
                on_triangle = (1 - u - v) * a[axis] + u * b[axis] + v * c[axis]
                self.assertAlmostEqual(on_triangle, ray[axis] + t * ray[3 + axis], places=5)

    def test_no_rays(self):
        report = self.trace([], 6)
        self.assertEqual((report["rays"], report["hits"]), (0, 0))
        self.assertEqual(read_hits(self.folder / "hits.npy"), [])

    def test_summary_line(self):
        path = write_npy(self.folder / "rays.npy", RAYS, 6)
        text = self.run_program("trace", self.cube, "--rays", path, "-o", "hits.npy").stdout
        self.assertRegex(text, r"5 rays, 3 hits, [\d.]+ Mrays/s")

    def test_bad_rays_name_the_row(self):
        good = RAYS[0] + (0, math.inf)
        bad = {
            "origin": (math.nan, 0, 0, 0, 0, 1, 0, 1), "direction": (0, 0, 0, math.inf, 0, 1, 0, 1),
            "zero": (0, 0, 0, 0, 0, 0, 0, 1), "tmin": (0, 0, 0, 0, 0, 1, -1, 1), "tmax": (0, 0, 0, 0, 0, 1, 2, 1),
            "nan": (0, 0, 0, 0, 0, 1, math.nan, 1),
        }
        for word, ray in bad.items():
            with self.subTest(word):
                path = write_npy(self.folder / "bad.npy", [good, good, ray], 8)
                self.refused("trace", self.cube, "--rays", path, "-o", "hits.npy", says=["bad.npy", "row 2", word])
                self.assertFalse((self.folder / "hits.npy").exists())

    def test_bad_files(self):
        def trace(path, *says):
            self.refused("trace", self.cube, "--rays", path, "-o", self.folder / "hits.npy", says=says)

        trace(self.folder / "missing.npy", "missing.npy")
        trace(self.cube, "cube.ply")
        trace(write_npy(self.folder / "seven.npy", [(0,) * 7], 7), "seven.npy", "7")
        trace(write_npy(self.folder / "whole.npy", [(0,) * 6], 6, dtype="<i4"), "whole.npy", "i4")
        cut = write_npy(self.folder / "cut.npy", RAYS, 6)
        cut.write_bytes(cut.read_bytes()[:-3])
        trace(cut, "cut.npy")

    def test_unwritable_hits(self):
        path = write_npy(self.folder / "rays.npy", RAYS, 6)
        self.refused("trace", self.cube, "--rays", path, "-o", self.folder / "missing" / "hits.npy", says="missing")
        self.refused("trace", self.cube, "--rays", path, "-o", self.folder, says=str(self.folder))


if __name__ == "__main__":
    unittest.main()

"""boxwood tune: a search that ends in time, a front without losers, a recommendation that can be run."""

import math
import unittest

from support import CommandLineTest, write_npy

SCENE = "scene:soup,triangles=300"


class Tune(CommandLineTest):
    def tune(self, *options):
        return self.report("tune", SCENE, "--size", "24x24", *options)

    def check_front(self, candidates):
        def beats(a, b):
            pairs = ((b["build_ms"], a["build_ms"]), (a["ratio"], b["ratio"]), (b["bytes"], a["bytes"]))
            return all(x >= y for x, y in pairs) and any(x > y for x, y in pairs)
        for candidate in candidates:
            self.assertEqual(candidate["on_front"], not any(beats(other, candidate) for other in candidates))

    def test_search(self):
        report = self.tune("--rays", "diffuse,occlusion", "--seconds", "1.5")
        self.assert_environment(report, "tune")
        self.assertGreater(report["trained_rays"], 20)
        self.assertLessEqual(abs(report["trained_rays"] - report["tested_rays"]), 2)
        candidates = report["candidates"]
        self.assertEqual((candidates[0]["builder"], candidates[0]["ratio"]), ("balanced", 1))
        self.assertGreater(len(candidates), 1)
        self.check_front(candidates)
        for candidate in candidates:
            self.assertGreater(candidate["mrays"], 0)
            self.assertGreater(candidate["bytes"], 300 * 36)
        best = report["recommendation"]
        self.assertGreaterEqual(best["ratio"], 0.95 * max(c["ratio"] for c in candidates))
        # What it says can be run.
        self.run_program("build", SCENE, *best["command_line"].split())
        self.assertIn(best["builder"], best["code"])

    def test_no_time_gives_the_default(self):
        report = self.tune("--rays", "random", "--seconds", "0")
        self.assertEqual(len(report["candidates"]), 1)
        self.assertIn("Keep the default", report["recommendation"]["sentence"])
        self.assertTrue(report["candidates"][0]["on_front"])

    def test_rays_of_a_file(self):
        rays = [(0.1 * i, -3, 0.05 * i, 0, 1, 0) for i in range(9)]
        path = write_npy(self.folder / "rays.npy", rays, 6)
        for query in ("closest", "any"):
            report = self.tune("--rays", path, "--query", query, "--seconds", "0")
            self.assertEqual((report["trained_rays"], report["tested_rays"]), (5, 4))

    def test_text(self):
        text = self.run_program("tune", SCENE, "--size", "16x16", "--rays", "random", "--seconds", "0").stdout
        self.assertRegex(text, r"Keep the default, balanced, wide(8|16):")
        self.assertRegex(text, r"command line: --builder balanced --layout wide(8|16)\n")
        self.assertIn("boxwood::Accel::build(mesh", text)

    def test_errors(self):
        self.refused("tune", SCENE, "--rays", "sideways", says="no rays 'sideways'")
        self.refused("tune", SCENE, "--rays", self.folder / "missing.npy", says="missing.npy")
        one = write_npy(self.folder / "one.npy", [(0, 0, 0, 1, 0, 0)], 6)
        self.refused("tune", SCENE, "--rays", one, says="has 1 rays")
        bad = write_npy(self.folder / "bad.npy", [(0, 0, 0, 1, 0, 0), (0, 0, 0, 0, 0, math.nan)], 6)
        self.refused("tune", SCENE, "--rays", bad, says="row 1")
        self.refused("tune", SCENE, "--size", "8x8", "--camera", "eye=90:90:90,look_at=180:180:180",
                     says="no primary ray meets")


if __name__ == "__main__":
    unittest.main()

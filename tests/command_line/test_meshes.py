"""INPUT and boxwood info: files, scenes, and what is wrong with them."""

import struct
import unittest

from support import CUBE_TRIANGLES, CUBE_VERTICES, CommandLineTest, write_ply


class Meshes(CommandLineTest):
    def test_info_of_a_cube(self):
        report = self.report("info", self.cube)
        self.assert_environment(report, "info")
        self.assertEqual(report["mesh"]["name"], "cube.ply")
        self.assertEqual(report["mesh"]["input"], str(self.cube))
        self.assert_hash(report["mesh"]["hash"])
        self.assertEqual(report["hash"], report["mesh"]["hash"])
        self.assertEqual((report["triangles"], report["vertices"]), (12, 8))
        self.assertEqual(report["bounds"], {"lower": [0, 0, 0], "upper": [1, 1, 1]})
        self.assertAlmostEqual(report["surface_area"], 6, places=6)
        self.assertEqual((report["non_finite"], report["degenerate"], report["duplicate"]), (0, 0, 0))
        self.assertEqual((report["components"], report["boundary_edges"], report["non_manifold_edges"]), (1, 0, 0))
        self.assertTrue(report["closed"])
        self.assertTrue(report["manifold"])
        self.assertTrue(report["keeps_file_order"])

    def test_info_of_a_broken_mesh(self):
        vertices = CUBE_VERTICES + [("nan", 0, 0), ("inf", 0, 0)]
        triangles = CUBE_TRIANGLES[1:] + [(0, 1, 8), (0, 1, 9), (3, 3, 3), CUBE_TRIANGLES[5]]
        path = write_ply(self.folder / "broken.ply", vertices, triangles)
        report = self.report("info", path)
        self.assertEqual((report["non_finite"], report["degenerate"], report["duplicate"]), (2, 1, 1))
        self.assertFalse(report["closed"])
        done = self.run_program("info", path, "--quiet")
        self.assertRegex(done.stderr, r"^boxwood: warning: .*2 of 15 triangles .*left out.*\n$")

    def test_excluded_triangles_are_always_reported(self):
        path = write_ply(self.folder / "nan.ply", CUBE_VERTICES + [("nan", 0, 0)], CUBE_TRIANGLES + [(0, 1, 8)])
        for command in (["build", path], ["bench", path, "--size", "8x8", "--repeat", 1, "--builders", "middle"],
                        ["render", path, "-o", "nan.png", "--size", "8x8"]):
            with self.subTest(command[0]):
                done = self.run_program(*command, "--quiet", "--json", "-")
                self.assertRegex(done.stderr, r"^boxwood: warning: .*1 of 13 triangles is .*left out.*\n$")
        self.assertEqual(self.report("build", path)["excluded"], 1)
        self.assertEqual(self.report("build", path)["references"], 12)

    def test_meshes_without_a_usable_triangle(self):
        only_nan = write_ply(self.folder / "only_nan.ply", [("nan", 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)])
        self.refused("build", only_nan, says="only_nan.ply")
        report = self.report("info", only_nan)
        self.assertEqual(report["non_finite"], 1)
        self.assertIsNone(report["bounds"])
        empty = write_ply(self.folder / "empty.ply", CUBE_VERTICES, [])
        for command in (["info", empty], ["build", empty], ["bench", empty], ["render", empty, "-o", "empty.png"]):
            self.refused(*command, says="empty.ply")

    def test_files_that_cannot_be_read(self):
        (self.folder / "text.obj").write_text("Dear reader,\nthis is a letter.\n")
        (self.folder / "void.ply").write_bytes(b"")
        (self.folder / "cut.ply").write_bytes(self.cube.read_bytes()[:-20])
        (self.folder / "cut.glb").write_bytes(b"glTF" + struct.pack("<II", 2, 4096) + b"\0" * 10)
        write_ply(self.folder / "range.ply", CUBE_VERTICES, CUBE_TRIANGLES + [(0, 1, 99)])
        for name in ("missing.ply", "text.obj", "void.ply", "cut.ply", "cut.glb", "range.ply"):
            with self.subTest(name):
                self.refused("info", self.folder / name, says=name)
        self.refused("info", self.folder, says=str(self.folder))
        self.assertIn("99", self.refused("build", self.folder / "range.ply"))

    def test_scene_options(self):
        small = self.report("info", "scene:atrium,triangles=2000,seed=3")
        self.assertEqual(small["mesh"]["seed"], 3)
        self.assertLessEqual(small["triangles"], 2200)
        self.assertGreater(small["triangles"], 200)
        again = self.report("info", "scene:atrium,seed=3,triangles=2000")
        self.assertEqual(small["hash"], again["hash"])
        turned = self.report("info", "scene:atrium,triangles=2000,seed=3,rotate=10:-20.5:30")
        self.assertNotEqual(small["hash"], turned["hash"])
        self.assertEqual(turned["mesh"]["rotate"], [10, -20.5, 30])

    def test_bad_scene_options(self):
        self.refused("info", "scene:atlantis", says=["atlantis", "atrium"])
        self.refused("info", "scene:", says="scene")
        self.refused("info", "scene:soup,triangle=10", says=["triangle", "seed"])
        self.refused("info", "scene:soup,triangles=11", says="11")
        self.refused("info", "scene:soup,triangles=0", says="0")
        self.refused("info", "scene:soup,triangles=-5", says="-5")
        self.refused("info", "scene:soup,triangles=1e3", says="1e3")
        self.refused("info", "scene:soup,triangles=99999999999999999999999", says="99999999999999999999999")
        self.refused("info", "scene:soup,rotate=1:2", says="1:2")
        self.refused("info", "scene:soup,rotate=1:2:nan", says="nan")
        self.refused("info", "scene:soup,seed=1,seed=2", says="seed")
        self.refused("info", "scene:soup,", says="scene:soup,")

    def test_every_scene_can_be_inspected(self):
        for scene in self.report("scenes"):
            with self.subTest(scene["id"]):
                report = self.report("info", f"scene:{scene['id']},triangles=3000")
                self.assertEqual(report["non_finite"], 0)
                self.assertLessEqual(report["triangles"], 3300)


if __name__ == "__main__":
    unittest.main()

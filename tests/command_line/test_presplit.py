"""boxwood presplits, --presplit everywhere, boxwood subdivide, --rotate and the defects of scenes."""

import unittest

from support import CommandLineTest, write_npy, write_ply

ATRIUM = "scene:atrium,triangles=5000,rotate=30:40:20"
# A bar from corner to corner: its triangles' boxes are mostly empty.
BAR = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (40, 50, 60), (41, 50, 60), (40, 51, 60)]
BAR_TRIANGLES = [(0, 2, 1), (3, 4, 5), (0, 1, 4), (0, 4, 3), (1, 2, 5), (1, 5, 4), (2, 0, 3), (2, 3, 5)]


class Presplits(CommandLineTest):
    def test_list(self):
        presplits = {row["id"]: row for row in self.report("presplits")}
        self.assertEqual(list(presplits)[0], "none")
        for name in ("evh", "evh:auto", "esc"):
            self.assertTrue(presplits[name]["paper"])
            self.assertTrue(presplits[name]["options"])
        self.assertEqual(presplits["evh"]["options"][0]["key"], "t")
        self.assertEqual(presplits["evh"]["options"][0]["default"], 14)
        self.assertTrue(presplits["evh"]["subdivides"])
        self.assertFalse(presplits["esc"]["subdivides"])
        text = self.run_program("presplits").stdout
        for name in presplits:
            self.assertIn(name, text)

    def test_build_reports_what_was_split(self):
        plain = self.report("build", ATRIUM, "-b", "sweep-sah")
        self.assertEqual(plain["options"]["presplit"], "none")
        self.assertEqual(plain["presplit"]["area_reduction"], 1)
        for presplit in self.report("presplits")[1:]:
            with self.subTest(presplit["id"]):
                # By default this one cuts only what is far looser than the rest, and here nothing is.
                wanted = "priority:loose=0.5" if presplit["id"] == "priority" else presplit["id"]
                report = self.report("build", ATRIUM, "-b", "sweep-sah", "--presplit", wanted)
                self.assertTrue(report["valid"])
                self.assertTrue(report["options"]["presplit"].startswith(presplit["id"]))
                split = report["presplit"]
                self.assertEqual(split["method"], report["options"]["presplit"])
                self.assertEqual(split["references_before"], plain["references"])
                self.assertGreater(split["references_after"], plain["references"])
                self.assertGreater(report["references"], plain["references"])
                self.assertGreaterEqual(split["references_after"], report["references"])
                self.assertNotEqual(split["area_reduction"], 1)
                self.assertLess(split["average_factor"], split["worst_factor"])
                if presplit["id"] in ("evh:clip", "esc"):
                    self.assertLess(report["surface_area_cost"], plain["surface_area_cost"])

    def test_same_tree_for_every_number_of_threads(self):
        hashes = {self.report("build", ATRIUM, "--presplit", "evh:auto,budget=1.5", "--threads", threads)["hash"]
                  for threads in (1, 2, 8)}
        self.assertEqual(len(hashes), 1)

    def test_bad_presplits(self):
        for command in (["build"], ["render", "-o", "x.png"], ["bench"], ["subdivide", "-o", "x.ply"]):
            self.refused(*command, self.cube, "--presplit", "evh:t=99", code=2, says=["99", "30"])
        self.refused("build", self.cube, "--presplit", "magic", code=2, says=["magic", "evh", "esc"])

    def test_trace_and_bench_and_render_take_it(self):
        rays = write_npy(self.folder / "rays.npy", [(0.3, 0.4, 5, 0, 0, -1), (9, 9, 9, 1, 0, 0)], 6)
        report = self.report("trace", self.cube, "--rays", rays, "-o", "hits.npy", "--presplit", "esc:k=40")
        self.assertEqual(report["hits"], 1)
        self.assertEqual(report["options"]["presplit"], "esc:k=40")
        report = self.report("bench", ATRIUM, "-b", "binned-sah,lbvh", "--size", "16x16", "--repeat", 1, "--presplit",
                             "evh:t=16", "--presplit", "none", "--presplit", "evh:auto,budget=1.2", "--threads", 1)
        self.assertEqual(report["options"]["presplits"], ["evh:t=16", "none", "evh:auto,budget=1.2,t.most=16"])
        self.assertEqual(len(report["rows"]), 2 * 3 * 4)
        for row in report["rows"]:
            self.assertEqual(row["disagreements"], 0)
            self.assertEqual(row["references"] > 5100, row["presplit"] != "none")
        report = self.report("render", ATRIUM, "-o", "split.png", "--size", "32x32", "--shade", "subdivided",
                             "--presplit", "evh")
        self.assertEqual(report["options"]["presplit"], "evh:t=14")
        self.assertTrue((self.folder / "split.png").stat().st_size > 100)


class Subdivide(CommandLineTest):
    def test_a_closed_mesh_stays_closed(self):
        bar = write_ply(self.folder / "bar.ply", BAR, BAR_TRIANGLES)
        self.assertTrue(self.report("info", bar)["closed"])
        report = self.report("subdivide", bar, "-o", "fine.ply", "--presplit", "evh:t=12")
        self.assert_environment(report, "subdivide")
        self.assertEqual(report["triangles_before"], 8)
        self.assertGreater(report["triangles_after"], 50)
        self.assertEqual(report["open_edges_after"], 0)
        self.assertTrue(report["watertightness_kept"])
        fine = self.report("info", self.folder / "fine.ply")
        self.assertTrue(fine["closed"] and fine["manifold"])
        self.assertEqual(fine["triangles"], report["triangles_after"])
        self.assertEqual(fine["vertices"], report["vertices_after"])
        self.assertAlmostEqual(fine["surface_area"] / self.report("info", bar)["surface_area"], 1, places=4)

    def test_only_methods_that_cut_edges(self):
        for presplit in ("esc", "none"):
            self.refused("subdivide", self.cube, "-o", "x.ply", "--presplit", presplit, says=[presplit, "evh"])


class Rotate(CommandLineTest):
    def test_files_and_scenes_turn_with_the_camera(self):
        plain = self.report("info", self.cube)
        turned = self.report("info", self.cube, "--rotate", "0:0:45")
        self.assertEqual(turned["mesh"]["turned"], [0, 0, 45])
        self.assertNotEqual(plain["hash"], turned["hash"])
        self.assertAlmostEqual(turned["bounds"]["upper"][0], 0.5 + 0.5 ** 0.5, places=5)
        self.assertAlmostEqual(plain["surface_area"], turned["surface_area"], places=5)
        for camera in ([], ["--camera", "eye=4:3:5,look_at=0.5:0.5:0.5"]):
            hits = [self.report("bench", self.cube, "-b", "binned-sah", "--rays", "primary", "--size", "64x64",
                                "--repeat", 1, "--rotate", turn, *camera)["rows"][0]["hits"]
                    for turn in ("0:0:0", "0:90:0", "30:40:20")]
            self.assertGreater(hits[0], 100)
            self.assertLess(max(hits) - min(hits), 20)
        self.refused("info", self.cube, "--rotate", "1:2", code=2, says="1:2")

    def test_a_quarter_turn_of_a_scene_is_its_own(self):
        ours = self.report("info", "scene:city,triangles=2000", "--rotate", "0:90:0")
        scenes = self.report("info", "scene:city,triangles=2000,rotate=0:90:0")
        self.assertEqual(ours["hash"], scenes["hash"])


class Defects(CommandLineTest):
    def test_far_triangles_and_a_split_without_a_fallback(self):
        for text in ("spike=1000", "outlier=1000"):
            report = self.report("build", f"scene:atrium,triangles=2000,{text}", "-b", "middle")
            self.assertTrue(report["valid"])
            self.assertEqual(report["max_leaf"], 1)
            self.assertEqual(report["mesh"][text.split("=")[0]], 1000)
        report = self.report("build", "scene:atrium,triangles=2000", "-b", "middle", "--set", "fallback=none")
        self.assertTrue(report["valid"])
        self.assertGreater(report["max_leaf"], 800)
        self.refused("info", "scene:atrium,spike=-1", says="-1")
        self.refused("info", "scene:atrium,outlier=far", says="far")


if __name__ == "__main__":
    unittest.main()

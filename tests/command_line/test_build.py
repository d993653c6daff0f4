"""boxwood build: keys, options, determinism."""

import itertools
import unittest

from support import INSTRUMENTED, CommandLineTest, write_ply


class Build(CommandLineTest):
    def builders(self):
        return [builder["id"] for builder in self.report("builders")]

    def test_keys_and_their_meaning(self):
        report = self.report("build", self.cube, "--builder", "sweep-sah")
        self.assert_environment(report, "build")
        self.assertEqual(report["builder"], "sweep-sah")
        self.assertIn(report["layout"], ("wide8", "wide16"))  # by the processor
        self.assertTrue(report["valid"])
        self.assertEqual(report["references"], 12)
        self.assertEqual(report["excluded"], 0)
        self.assertEqual(report["nodes"], 2 * report["leaves"] - 1)
        self.assertEqual(sum(n * c for n, c in enumerate(report["leaf_histogram"])), 12)
        self.assertEqual(sum(report["leaf_histogram"]), report["leaves"])
        self.assertEqual(len(report["leaf_histogram"]) - 1, report["max_leaf"])
        self.assertGreater(report["surface_area_cost"], 0)
        self.assertGreater(report["bytes"], 12 * 36)
        self.assertAlmostEqual(report["build_ms"], sum(report["times_ms"].values()), places=6)
        self.assertGreater(report["peak_memory_bytes"], 1 << 20)
        self.assert_hash(report["hash"])
        self.assertEqual(report["options"]["builder"], "sweep-sah")
        self.assertIn("cost.traversal", report["options"])

    def test_every_builder_and_layout_is_valid_and_the_same_for_all_threads(self):
        scene = self.report("scenes")[0]["id"]
        layouts = ("linear", "wide4", "wide8-quads", "wide16")
        pairs = itertools.product(self.builders(), layouts)
        if INSTRUMENTED:
            pairs = [*zip(self.builders(), itertools.cycle(layouts))]
        for builder, layout in pairs:
            with self.subTest(builder=builder, layout=layout):
                reports = [self.report("build", f"scene:{scene},triangles=5000", "-b", builder, "-l", layout,
                                       "--threads", threads) for threads in (1, 2, 8)]
                self.assertEqual(len({r["hash"] for r in reports}), 1)
                self.assertEqual(len({r["surface_area_cost"] for r in reports}), 1)
                self.assertTrue(all(r["valid"] for r in reports))

    def test_costs_reach_the_builder_and_the_metric(self):
        one = self.report("build", self.cube, "-b", "middle")
        two = self.report("build", self.cube, "-b", "middle", "--set", "cost.traversal=2", "--set",
                          "cost.intersection=3")
        self.assertEqual(two["options"]["cost.traversal"], 2)
        self.assertEqual(two["options"]["cost.intersection"], 3)
        if one["hash"] == two["hash"] and one["options"]["cost.intersection"] == 1.5:
            self.assertAlmostEqual(two["surface_area_cost"], 2 * one["surface_area_cost"], places=4)
        self.assertNotEqual(one["surface_area_cost"], two["surface_area_cost"])

    def test_bad_options(self):
        self.refused("build", self.cube, "--builder", "magic", says=["magic", "sweep-sah"])
        self.refused("build", self.cube, "--layout", "wide5", says=["wide5"])
        self.refused("build", self.cube, "--set", "bims=3", says=["bims", "bins"])
        self.refused("build", self.cube, "--set", "bins=many", says="many")
        self.refused("build", self.cube, "--set", "bins=-4", says="-4")
        self.refused("build", self.cube, "--set", "bins=4", "--set", "bins=8", says="bins")
        self.refused("build", self.cube, "--set", "cost.intersection=nan", says="nan")

    def test_validation_can_be_left_out(self):
        self.assertIsNone(self.report("build", self.cube, "--no-validate")["valid"])
        self.assertIn("not checked", self.run_program("build", self.cube, "--no-validate").stdout)

    def test_metrics(self):
        self.assertNotIn("end_point_overlap", self.report("build", self.cube))
        exact = self.report("build", "scene:atrium,triangles=3000", "--metrics")
        self.assertGreater(exact["end_point_overlap"], 0)
        self.assertEqual(exact["end_point_overlap_error"], 0)
        self.assertGreater(exact["leaf_count_variability"], 5 * exact["leaf_count_variability_error"])
        self.assertTrue(0 <= exact["sibling_overlap_volume"] <= 1 and 0 <= exact["sibling_overlap_area"] <= 1)
        self.assertEqual(exact["references_per_primitive"], 1)
        sampled = self.report("build", "scene:atrium,triangles=3000", "--metrics", "--overlap-samples", 1000)
        self.assertGreater(sampled["end_point_overlap_error"], 0)
        self.assertAlmostEqual(sampled["end_point_overlap"], exact["end_point_overlap"],
                               delta=5 * sampled["end_point_overlap_error"])
        self.assertIn("EPO", self.run_program("build", self.cube, "--metrics").stdout)
        self.refused("build", self.cube, "--overlap-samples", 5, code=2, says="--metrics")

    def test_awkward_meshes(self):
        corners = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]
        meshes = {
            "one": (corners, [(0, 1, 2)]),
            "two": (corners + [(0, 0, 5)], [(0, 1, 2), (0, 1, 3)]),
            "equal": (corners, [(0, 1, 2)] * 300),
            "point": ([(1, 2, 3)], [(0, 0, 0)] * 20),
            "huge": ([(x * 1e17, y * 1e17, z) for x, y, z in corners], [(0, 1, 2)] * 3),
            "tiny": ([(x * 1e-30, y * 1e-30, z) for x, y, z in corners], [(0, 1, 2)] * 3),
        }
        pairs = itertools.product(meshes.items(), self.builders())
        if INSTRUMENTED:
            pairs = zip(itertools.cycle(meshes.items()), self.builders())
        for (name, mesh), builder in pairs:
            with self.subTest(mesh=name, builder=builder):
                path = write_ply(self.folder / f"{name}.ply", *mesh)
                report = self.report("build", path, "--builder", builder)
                self.assertTrue(report["valid"])
                self.assertGreaterEqual(report["references"], len(mesh[1]))


if __name__ == "__main__":
    unittest.main()

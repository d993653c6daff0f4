"""Quality levels and optimizers: what they stand for, wherever a builder is named."""

import unittest

from support import CommandLineTest

SCENE = "scene:atrium,triangles=5000"


class Levels(CommandLineTest):
    def test_a_level_is_what_it_stands_for(self):
        levels = {level["id"]: level for level in self.report("levels")}
        self.assertEqual(list(levels), ["fast", "balanced", "best"])
        for level in levels.values():
            with self.subTest(level["id"]):
                named = self.report("build", SCENE, "--builder", level["id"])
                settings = [word for key, value in level["settings"].items() for word in ("--set", f"{key}={value}")]
                spelt = self.report("build", SCENE, "--builder", level["builder"], "--presplit", level["presplit"],
                                    "--optimizer", level["optimizer"], *settings)
                kept = spelt["hash"]
                if level["second_builder"]:
                    second = self.report("build", SCENE, "--builder", level["second_builder"], "--presplit",
                                         level["presplit"], "--optimizer", level["optimizer"])
                    ratio = second["surface_area_cost"] / spelt["surface_area_cost"]
                    self.assertAlmostEqual(named["notes"]["cost of whole triangles by that of split ones"], ratio)
                    kept = second["hash"] if ratio <= 1.025 else kept
                    self.assertEqual(named["built_by"], level["second_builder" if ratio <= 1.025 else "builder"])
                    self.assertEqual(named["options"].pop("second_builder"), level["second_builder"])
                self.assertEqual(named["hash"], kept)
                self.assertTrue(named["valid"])
                self.assertEqual(named["options"].pop("level"), level["id"])
                self.assertEqual(named["options"], spelt["options"])

    def test_expected_costs_of_levels_and_builders_are_in_the_same_prices(self):
        def row(*builder):
            words = ["--rays", "primary", "--size", "8x8", "--repeat", 1, "--threads", 1, "--layouts", "linear"]
            return self.report("bench", SCENE, "-b", *builder, *words)["rows"][0]

        level = {row["id"]: row for row in self.report("levels")}["balanced"]
        self.assertIn("cost.intersection", level["settings"])
        prices = ["--set", "cost.traversal=1", "--set", "cost.intersection=1.5"]
        for command in (row, lambda *words: self.report("build", SCENE, "-b", *words)):
            unpriced = command("balanced")["surface_area_cost"]
            own = command("balanced", "--set", f"cost.intersection={level['settings']['cost.intersection']}")
            self.assertGreater(unpriced, 1.2 * own["surface_area_cost"])
            self.assertGreater(unpriced, 0.9 * command("binned-sah", *prices)["surface_area_cost"])

    def test_balanced_is_the_default(self):
        self.assertEqual(self.report("build", SCENE)["options"]["level"], "balanced")

    def test_what_is_given_goes_before_the_level(self):
        report = self.report("build", SCENE, "-b", "best", "--optimizer", "none", "--presplit", "evh:t=12", "--set",
                             "growth=1.25")
        options = report["options"]
        self.assertEqual((options["optimizer"], options["presplit"], options["growth"]), ("none", "evh:t=12", 1.25))
        self.assertNotEqual(report["hash"], self.report("build", SCENE, "-b", "best")["hash"])

    def test_the_same_tree_with_any_number_of_threads(self):
        self.assertEqual(len({self.report("build", SCENE, "-b", "best", "--threads", n)["hash"] for n in (1, 2, 5)}), 1)

    def test_an_optimizer_makes_the_tree_cheaper(self):
        for builder in ("lbvh", "sbvh"):
            plain = self.report("build", SCENE, "-b", builder)
            better = self.report("build", SCENE, "-b", builder, "--optimizer", "reinsertion:passes=2")
            self.assertLess(better["surface_area_cost"], plain["surface_area_cost"])
            self.assertEqual(better["references"], plain["references"])
            self.assertTrue(better["valid"])
            self.assertLessEqual(better["notes"]["reinsertion: passes"], 2)

    def test_bench_takes_levels_and_optimizers(self):
        report = self.report("bench", "scene:city,triangles=5000", "-b", "fast,best,lbvh", "--optimizer", "none",
                             "--optimizer", "reinsertion", "--size", "16x16", "--repeat", 1, "--rays", "primary",
                             "--threads", 1)
        self.assertEqual(report["options"]["builders"]["best"]["builder"], "sbvh")
        rows = {(row["builder"], row["optimizer"].split(":")[0]): row for row in report["rows"]}
        self.assertEqual(len(rows), 6)
        self.assertEqual({row["hits"] for row in rows.values()}, {rows["fast", "none"]["hits"]})
        for level in ("fast", "best", "lbvh"):
            self.assertNotEqual(rows[level, "none"]["hash"], rows[level, "reinsertion"]["hash"])

    def test_bad_names(self):
        self.refused("build", self.cube, "--builder", "finest", says=["finest", "sbvh", "best"])
        self.refused("build", self.cube, "--optimizer", "magic", code=2, says=["magic", "reinsertion"])
        self.refused("build", self.cube, "--optimizer", "reinsertion:passes=-1", code=2, says=["passes", "-1", "1000"])
        self.refused("build", self.cube, "--optimizer", "reinsertion:passes=1.5", code=2, says="whole number")
        self.refused("build", self.cube, "--builder", "best", "--set", "bims=3", says="bims")


if __name__ == "__main__":
    unittest.main()

"""boxwood duel and boxwood ablate: contests, agreement of hits, cameras from a file, what each technique costs."""

import csv
import io
import json
import math
import unittest

from support import CommandLineTest

SCENE = "scene:atrium,triangles=3000"
QUICK = ["--size", "24x24", "--repeat", 2, "--threads", 2]
LEVELS = ["--fast", "lbvh", "--balanced", "binned-sah", "--best", "sweep-sah"]


class Duel(CommandLineTest):
    def duel(self, *arguments):
        done = self.run_program("duel", *arguments, *QUICK, *LEVELS, "--json", "-")
        return json.loads(done.stdout), done.stderr

    def test_contests_cells_and_agreement(self):
        report, warnings = self.duel(SCENE)
        self.assert_environment(report, "duel")
        cells, contests = report["cells"], {contest["id"]: contest for contest in report["contests"]}
        rays = {(cell["group"], cell["rays"]) for cell in cells}
        for kind in ("primary", "random", "diffuse"):
            for group in ("closest-fast", "closest-robust", "trace-balanced", "trace-fast"):
                self.assertIn((group, kind), rays)
        for pair in [("any-hit", "occlusion"), ("batch-incoherent", "diffuse, shuffled"), ("batch-incoherent", "random"),
                     ("batch-coherent", "primary"), ("batch-coherent-any", "primary"), ("build-balanced", "1 thread"),
                     ("build-balanced", "2 threads"), ("build-fast", "1 thread"), ("bytes", "-")]:
            self.assertIn(pair, rays)
        for cell in cells:
            self.assertGreater(cell["our_value"], 0)
        self.assertEqual(contests["bytes"]["cells"], 1)
        self.assertEqual({kind for group, kind in rays if group == "optimize"},
                         {"primary", "random", "diffuse", "occlusion"})
        self.assertEqual(contests["batch-incoherent-large"]["cells"], 0)
        self.assertEqual(contests["batch-incoherent-large"]["reached"], "-")
        if report["rival_version"] is None:
            self.assertIn("Embree was not found", warnings)
            self.assertEqual({cell["ratio"] for cell in cells if cell["group"] != "optimize"}, {None})
            self.skipTest("this build has no Embree; it said so")
        self.assertNotIn("Embree", warnings)
        ratios = [cell["ratio"] for cell in cells if cell["group"] == "closest-fast"]
        self.assertEqual(len(ratios), 3)
        mean = math.exp(sum(map(math.log, ratios)) / 3)
        self.assertAlmostEqual(contests["closest-fast"]["mean"], mean, places=6)
        self.assertEqual(contests["closest-fast"]["worst"], min(ratios))
        for cell in cells:
            if cell["group"] != "bytes":
                self.assertLessEqual(cell["ratio_min"], cell["ratio"])
                self.assertLessEqual(cell["ratio"], cell["ratio_max"])
        self.assertEqual({cell["rival"] for cell in cells if cell["group"] == "batch-coherent-any"} -
                         {"embree:medium:packets", "embree:high:packets"}, set())
        agreements = {(a["rays"], a["query"]): a for a in report["agreements"]}
        self.assertEqual(set(agreements), {("primary", "closest"), ("random", "closest"), ("diffuse", "closest"),
                                           ("occlusion", "any"), ("primary", "any")})
        for agreement in agreements.values():
            self.assertGreater(agreement["hits"], 0)
            self.assertEqual(agreement["ours_wrong"], 0, agreement)
            self.assertEqual(agreement["judged"], agreement["differ"])
        self.assertEqual(agreements["primary", "closest"]["hits"], agreements["primary", "any"]["hits"])

    def test_text_markdown_and_csv(self):
        markdown, table = self.folder / "duel.md", self.folder / "cells.csv"
        done = self.run_program("duel", self.cube, *QUICK, *LEVELS, "--markdown", markdown, "--csv", table)
        for word in ("Targets", "Scenes", "closest hit, single calls", "cube.ply"):
            self.assertIn(word, done.stdout)
            self.assertIn(word, markdown.read_text())
        self.assertIn("Speeds", done.stdout)
        self.assertIn("| --- |", markdown.read_text())
        rows = list(csv.DictReader(io.StringIO(table.read_text())))
        self.assertEqual({row["scene"] for row in rows}, {"cube.ply"})
        self.assertGreater(float(rows[0]["our_value"]), 0)

    def test_cameras_from_a_file(self):
        cameras = self.folder / "cameras.json"
        camera = {"eye": [0.5, 0.5, -4], "look_at": [0.5, 0.5, 0], "up": [0, 1, 0], "fov": 20}
        cameras.write_text(json.dumps({"cube": camera}))
        expected = "eye=0.5:0.5:-4,look_at=0.5:0.5:0,up=0:1:0,fov=20"
        report, warnings = self.duel(self.cube, "--cameras", cameras)
        self.assertEqual(report["inputs"][0]["camera"], expected)
        self.assertNotIn("no camera", warnings)
        for option in ("--cameras", "--camera"):
            bench = self.report("bench", self.cube, "--builders", "middle", option, cameras, *QUICK)
            self.assertEqual(bench["inputs"][0]["camera"], expected)
        cameras.write_text(json.dumps({"sphere": camera}))
        done = self.run_program("bench", self.cube, "--builders", "middle", "--cameras", cameras, "--json", "-", *QUICK)
        self.assertIn("has no camera 'cube'", done.stderr)
        cameras.write_text("[1, 2]")
        self.refused("duel", self.cube, "--cameras", cameras, *QUICK, *LEVELS, says="not a JSON object")
        cameras.write_text(json.dumps({"cube": {**camera, "eye": [1, 2]}}))
        self.refused("duel", self.cube, "--cameras", cameras, *QUICK, *LEVELS, says=["cube", "eye"])
        cameras.write_text(json.dumps({"cube": {**camera, "fov": 180}}))
        self.refused("bench", self.cube, "--cameras", cameras, *QUICK, says=["cube", "fov"])
        self.refused("bench", self.cube, "--camera", self.folder / "none.json", *QUICK, says="none.json")

    def test_bad_options(self):
        self.refused("duel", self.cube, "--best", "magic", says="magic")
        self.refused("duel", self.cube, "--layout", "round", says="round")
        self.refused("duel", self.cube, "--size", "big", code=2, says="big")
        self.refused("duel", self.cube, "--repeat", 0, code=2, says="0")
        self.refused("duel", self.cube, "--csv", "-", "--json", "-", code=2, says="standard output")
        self.refused("duel", self.folder / "none.ply", *QUICK, *LEVELS, says="none.ply")


class Ablate(CommandLineTest):
    def test_each_technique_is_left_out_alone(self):
        report = self.report("ablate", SCENE, "--builder", "sbvh", "--presplit", "evh:t=14", "--layout", "wide8",
                             *QUICK)
        self.assert_environment(report, "ablate")
        rows = {(row["without"], row["rays"]): row for row in report["rows"]}
        self.assertEqual(len(rows), len(report["rows"]))
        techniques = {technique for technique, _ in rows}
        price = "the layout's node price (2 blocks instead)"
        for technique in ("pre-split", "spatial splits", "eight children a node", price, "wide nodes and blocks",
                          "huge pages"):
            self.assertIn(technique, techniques)
        self.assertGreater(rows[price, "primary"]["memory_cost"], 0, "cheaper nodes make more of them")
        self.assertNotIn("quads", techniques)
        for technique in techniques:
            self.assertEqual({rays for t, rays in rows if t == technique}, {"primary", "random", "diffuse", "occlusion"})
        self.assertNotEqual(rows["spatial splits", "primary"]["memory_cost"], 0, "another tree without them")
        for row in report["rows"]:
            self.assertLessEqual(row["ray_cost_min"], row["ray_cost"])
            self.assertLessEqual(row["ray_cost"], row["ray_cost_max"])

    def test_what_the_whole_does_without_is_said(self):
        text = self.run_program("ablate", self.cube, "--builder", "sweep-sah", *QUICK).stdout
        self.assertIn("left out: spatial splits: sweep-sah does without", text)
        self.assertIn("wide nodes and blocks", text)
        self.refused("ablate", code=2, says="INPUT")
        self.refused("ablate", self.cube, "--builder", "magic", says="magic")


if __name__ == "__main__":
    unittest.main()

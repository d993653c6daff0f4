"""boxwood reproduce: tables in all forms, papers' values beside ours, charts, errors."""

import csv
import io
import json
import unittest

from support import CommandLineTest, write_ply

SMALL = "scene:atrium,triangles=400"
QUICK = ["--size", "16x16", "--random-rays", 400, "--repeat", 1, "--threads", 2]
TABLES = ["ebbvh-1", "ebbvh-2", "ebbvh-3", "evh-1", "evh-4", "evh-5", "popov-1", "popov-2", "popov-3", "popov-4",
          "popov-6", "builders"]


class Reproduce(CommandLineTest):
    def table(self, identifier, *arguments):
        report = self.report("reproduce", identifier, *arguments, *QUICK)
        self.assertEqual([table["id"] for table in report["tables"]], [identifier])
        return report["tables"][0]

    def test_every_table_of_a_small_scene_has_our_values(self):
        report = self.report("reproduce", "all", SMALL, *QUICK)
        self.assertEqual([table["id"] for table in report["tables"]], TABLES)
        for table in report["tables"]:
            if table["id"] == "evh-5":  # turns the paper's Sponza only
                self.assertEqual(table["rows"], [])
                continue
            self.assertGreater(len(table["rows"]), 0, table["id"])
            for row in table["rows"]:
                for name, cell in row["cells"].items():
                    self.assertIsNone(cell["paper"], f"{table['id']} {row}")
                    self.assertTrue(cell["ours"] is not None or cell.get("note"), f"{table['id']} {row} {name}")

    def test_classic_rows_are_the_sweep(self):
        table = self.table("popov-4", SMALL)
        built = self.report("build", SMALL, "--builder", "sweep-sah", "--set", "cost.traversal=2", "--set",
                            "cost.intersection=3")
        row = next(row for row in table["rows"] if row["type"] == "C-BVH")
        self.assertAlmostEqual(row["cells"]["Exp"]["ours"], built["surface_area_cost"], places=6)
        self.assertEqual(row["cells"]["random"]["our_ratio"], 1)

    def sheet(self, name, side):
        """A flat grid of 2 * side * side triangles."""
        vertices = [(x, y, 0) for y in range(side + 1) for x in range(side + 1)]
        triangles = []
        for y in range(side):
            for x in range(side):
                v = y * (side + 1) + x
                triangles += [(v, v + 1, v + side + 1), (v + 1, v + side + 2, v + side + 1)]
        return write_ply(self.folder / name, vertices, triangles)

    def test_a_mesh_is_matched_by_name_and_count(self):
        # The paper's kitchen has 110,561 triangles: a mesh of that name within a tenth has its values beside ours.
        row = self.table("evh-1", self.sheet("my_kitchen.ply", 230))["rows"][0]
        self.assertEqual(row["scene"], "Kitchen (my_kitchen.ply)")
        self.assertEqual(row["cells"]["average"]["paper"], 0.463)
        self.assertEqual(row["cells"]["average"]["note"], "nothing cut")
        row = self.table("evh-1", self.sheet("small_kitchen.ply", 20))["rows"][0]
        self.assertEqual(row["scene"], "small_kitchen.ply")
        self.assertIsNone(row["cells"]["average"]["paper"])

    def test_all_forms_say_the_same(self):
        folder = self.folder / "charts"
        folder.mkdir()
        markdown, cells = self.folder / "tables.md", self.folder / "cells.csv"
        report = self.report("reproduce", "popov-6", SMALL, *QUICK, "--markdown", markdown, "--csv", cells, "--charts",
                             folder)
        rows = list(csv.DictReader(io.StringIO(cells.read_text())))
        ours = report["tables"][0]["rows"][0]["cells"]
        self.assertEqual({row["column"] for row in rows}, set(ours))
        for row in rows:
            self.assertEqual(row["table"], "popov-6")
            self.assertAlmostEqual(float(row["ours"]), ours[row["column"]]["ours"], places=3)
        text = markdown.read_text()
        self.assertIn("## popov-6:", text)
        self.assertIn("boxwood reproduce popov-6", text)
        self.assertIn("![", text)
        chart = (folder / "popov-6.svg").read_text()
        self.assertTrue(chart.startswith("<svg") and chart.rstrip().endswith("</svg>"))
        self.assertEqual(chart.count("<circle"), len(ours))

    def test_cameras_come_from_a_file(self):
        cameras = self.folder / "cameras.json"
        cameras.write_text(json.dumps({"cube": {"eye": [9, 9, 9], "look_at": [99, 99, 99], "up": [0, 1, 0]}}))
        away = self.table("popov-2", self.cube, "--cameras", cameras)["rows"][0]["cells"]["Cost"]["ours"]
        seen = self.table("popov-2", self.cube)["rows"][0]["cells"]["Cost"]["ours"]
        self.assertLess(away, 1.01)  # rays that leave the scene look at the root only
        self.assertGreater(seen, away)

    def test_errors_are_sentences(self):
        self.refused("reproduce", "popov-9", says=["popov-9", "popov-6"])
        self.refused("reproduce", "evh-1", SMALL, "--cameras", "missing.json", says="missing.json")
        bad = self.folder / "bad.json"
        bad.write_text(json.dumps({"cube": {"eye": [1, 2], "look_at": [0, 0, 0], "up": [0, 1, 0]}}))
        self.refused("reproduce", "evh-1", self.cube, "--cameras", bad, says="eye")
        self.refused("reproduce", "evh-4", SMALL, "--charts", self.folder / "nowhere", says="nowhere")


if __name__ == "__main__":
    unittest.main()

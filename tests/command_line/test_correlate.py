"""boxwood correlate: its correlations are those of its rows."""

import csv
import io
import math
import unittest

from support import CommandLineTest

SCENE = "scene:atrium,triangles=3000"
QUICK = ["--size", "32x32", "--repeat", 1, "--threads", 1]


def pearson(x, y):
    mean_x, mean_y = sum(x) / len(x), sum(y) / len(y)
    xy = sum((a - mean_x) * (b - mean_y) for a, b in zip(x, y))
    return xy / math.sqrt(sum((a - mean_x) ** 2 for a in x) * sum((b - mean_y) ** 2 for b in y))


class Correlate(CommandLineTest):
    def test_correlations_follow_from_the_rows(self):
        report = self.report("correlate", SCENE, "--builders", "middle,equal-counts,sweep-sah,lbvh", "--rays",
                             "random,lines", "--layouts", "linear,wide8", *QUICK)
        self.assert_environment(report, "correlate")
        groups = {}
        for row in report["rows"]:
            groups.setdefault((row["rays"], row["layout"], row["terminating"]), []).append(row)
        self.assertEqual(set(groups), {(kind, layout, ends) for kind in ("random", "lines") for layout, ends in
                                       (("linear", True), ("linear", False), ("wide8", True))})
        measures = set()
        for line in report["correlations"]:
            rows = groups[line["rays"], line["layout"], line["terminating"]]
            self.assertEqual(line["builders"], 4)
            measures.add(line["measure"])
            x = [row[line["measure"]] for row in rows]
            y = [row["cost_per_ray" if line["with"] == "cost" else "ns_per_ray"] for row in rows]
            if line["pearson"] is None:
                self.assertEqual(len(set(x)), 1)
            else:
                self.assertAlmostEqual(line["pearson"], pearson(x, y), places=6)
        self.assertIn("end_point_overlap", measures)
        self.assertIn("surface_area_cost", measures)

    def test_lines_that_nothing_ends_cost_what_the_model_says(self):
        report = self.report("correlate", SCENE, "--builders", "middle,sweep-sah", "--rays", "lines", "--random-rays",
                             20000, *QUICK)
        for row in report["rows"]:
            if not row["terminating"]:
                self.assertAlmostEqual(row["cost_per_ray"] / row["surface_area_cost"], 1, delta=0.05)

    def test_text_and_csv(self):
        text = self.run_program("correlate", SCENE, "--rays", "random", *QUICK).stdout
        self.assertIn("random, linear, robust, non-terminating", text)
        self.assertIn("r with cost/ray", text)
        rows = list(csv.DictReader(io.StringIO(
            self.run_program("correlate", SCENE, "--rays", "random", "--csv", "-", *QUICK).stdout)))
        self.assertEqual({row["with"] for row in rows}, {"cost", "time"})
        self.assertEqual(len(rows), 2 * 2 * 9)

    def test_bad_options(self):
        self.refused("correlate", code=2, says="INPUT")
        self.refused("correlate", self.cube, "--builders", "magic", says="magic")
        self.refused("correlate", self.cube, "--csv", "-", "--json", "-", code=2, says="standard output")


if __name__ == "__main__":
    unittest.main()

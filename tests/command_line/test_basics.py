"""Help, version, usage errors, registries, outputs: what all sub-commands share."""

import json
import os
import subprocess
import unittest

from support import PROGRAM, CommandLineTest

COMMANDS = ["builders", "presplits", "optimizers", "levels", "scenes", "info", "build", "subdivide", "trace", "bench", "render"]


class Basics(CommandLineTest):
    def test_version(self):
        self.assertRegex(self.run_program("--version").stdout, r"^boxwood \d+\.\d+\.\d+\n$")

    def test_help_has_examples_and_all_commands(self):
        text = self.run_program("--help").stdout
        self.assertIn("Examples:", text)
        for command in COMMANDS:
            self.assertIn(f"\n  {command} ", text)

    def test_help_of_each_command_has_examples_and_common_options(self):
        for command in COMMANDS:
            with self.subTest(command):
                text = self.run_program(command, "--help").stdout
                self.assertIn("Examples:", text)
                self.assertIn(f"boxwood {command}", text)
                for option in ("--json", "--threads", "--quiet"):
                    self.assertIn(option, text)

    def test_usage_errors_are_exit_code_2(self):
        self.refused(code=2)
        self.refused("fly", code=2, says=["fly", "render"])
        self.refused("info", code=2, says="INPUT")
        self.refused("info", self.cube, "--colour", code=2, says="--colour")
        self.refused("build", self.cube, "--set", "bins", code=2, says="bins")
        self.refused("render", self.cube, code=2, says="--output")
        self.refused("trace", self.cube, "--rays", "r.npy", "-o", "h.npy", "--query", "some", code=2, says="some")
        self.refused("trace", self.cube, "--rays", "r.npy", "-o", "h.npy", "--mode", "rough", code=2, says="rough")

    def test_threads_out_of_range(self):
        for threads in ("-1", "1000000", "two", "1.5"):
            with self.subTest(threads):
                self.refused("info", self.cube, "--threads", threads, code=2, says=threads)

    def test_threads_are_what_was_asked_for(self):
        for threads in (1, 2, 5):
            self.assertEqual(self.report("build", self.cube, "--threads", threads)["threads"], threads)
        self.assertEqual(self.report("build", self.cube, "--threads", 0)["threads"],
                         self.report("build", self.cube)["threads"])

    def test_builders_lists_the_registry(self):
        report = self.report("builders")
        ids = [builder["id"] for builder in report]
        for expected in ("middle", "equal-counts", "binned-sah", "sweep-sah", "lbvh", "hlbvh"):
            self.assertIn(expected, ids)
        self.assertEqual(len(ids), len(set(ids)))
        lines = self.run_program("builders").stdout.splitlines()
        levels = [level["id"] for level in self.report("levels")]
        self.assertEqual([line.split()[0] for line in lines], levels + ids)
        for builder in report:
            keys = [option["key"] for option in builder["options"]]
            self.assertIn("cost.traversal", keys)
            self.assertIn("cost.intersection", keys)
            self.assertTrue(builder["summary"])
        text = self.run_program("builders", "--settings").stdout
        self.assertIn("cost.traversal", text)
        self.assertIn("bins", text)

    def test_scenes_lists_the_registry(self):
        report = self.report("scenes")
        ids = [scene["id"] for scene in report]
        self.assertGreaterEqual(len(ids), 7)
        self.assertIn("atrium", ids)
        lines = self.run_program("scenes").stdout.splitlines()
        self.assertEqual([line.split()[0] for line in lines], ids)

    def test_json_to_a_file_equals_json_to_standard_output(self):
        path = self.folder / "report.json"
        done = self.run_program("builders", "--json", path)
        self.assertTrue(done.stdout)
        self.assertEqual(json.loads(path.read_text()), self.report("builders"))
        self.assertEqual([p.name for p in self.folder.iterdir() if "report" in p.name], ["report.json"])

    def test_unwritable_outputs(self):
        self.refused("builders", "--json", self.folder / "missing" / "report.json", says="missing")
        self.refused("build", self.cube, "--json", self.folder / "missing" / "report.json", says="missing")
        self.refused("build", self.cube, "--json", self.folder, says=str(self.folder))
        self.refused("bench", self.cube, "--csv", self.folder / "missing" / "rows.csv", says="missing")
        self.refused("render", self.cube, "-o", self.folder / "missing" / "a.png", says="missing")
        if os.path.exists("/dev/full"):
            self.refused("builders", "--json", "/dev/full", says="/dev/full")

    @unittest.skipUnless(os.path.exists("/dev/full"), "needs /dev/full")
    def test_full_standard_output(self):
        with open("/dev/full", "w") as full:
            done = subprocess.run([PROGRAM, "builders"], stdout=full, stderr=subprocess.PIPE, text=True, timeout=60)
        self.assertEqual(done.returncode, 1)
        self.assertEqual(done.stderr, "boxwood: standard output can't be written\n")

    def test_old_output_survives_a_failed_run(self):
        path = self.folder / "report.json"
        path.write_text("old")
        self.refused("build", "nothing.ply", "--json", path, says="nothing.ply")
        self.assertEqual(path.read_text(), "old")

    def test_quiet_prints_the_result_only(self):
        loud = self.run_program("build", self.cube).stdout
        quiet = self.run_program("build", self.cube, "--quiet").stdout
        self.assertIn("boxwood ", loud)
        self.assertNotIn("boxwood ", quiet)
        self.assertIn("Exp(T)", quiet)

    def test_no_progress_bar_without_a_terminal(self):
        self.assertEqual(self.run_program("build", "scene:soup,triangles=1000").stderr, "")

    def test_forced_instruction_set(self):
        self.assertEqual(self.report("build", self.cube, environment={"BOXWOOD_ISA": "scalar"})["isa"], "scalar")
        self.refused("build", self.cube, says="quantum", environment={"BOXWOOD_ISA": "quantum"})
        self.refused("bench", self.cube, says="quantum", environment={"BOXWOOD_ISA": "quantum"})


if __name__ == "__main__":
    unittest.main()

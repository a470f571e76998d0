#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""handcast benchmark."""
import json
import pathlib
import shutil
import signal
import subprocess
import time
import tomllib
import unittest

from programs import PATIENCE_S, REPOSITORY, Test, program
from sweeps import write_sweep

from pages.benchmark.plans import FIRST_PERSON, PLANS, Row, folder_of_plans, write_plan
from pages.benchmark.table import markdown, rows_of
from pages.chart.results import read_results
from pages.files import Problem

HEAD = f"""rig = "{REPOSITORY}/config/rigs/twin.toml"
seconds = 0.3
warm_up_s = 0.1
draw_every = 48

[settings]
landmarks.backend = "twin"

[[variant]]
name = "paper_at_our_speed"
rig = "{REPOSITORY}/config/rigs/paper.toml"

[[variant]]
name = "handcast"

"""
TINY = {"benchmark": 'twin.motion = ["builtin:wave", "/no/such/folder"]\ntwin.shape.mesh = ["implicit"]\ntwin.seed = [101]\n',
        "benchmark_stress": 'twin.tracker.age_ms = [5, 30]\ntwin.seed = [101]\n'}


class ThePlans(Test):
    def setUp(self):
        super().setUp()
        self.shipped = folder_of_plans(None)

    def plan(self, name="benchmark", **more):
        """A plan as it is run."""
        return tomllib.loads(write_plan(name, self.shipped, more.pop("people", 0), self.folder, **more).read_text())

    def test_are_half_recordings_and_of_one_version(self):
        motions = self.plan()["grid"]["twin"]["motion"]
        self.assertEqual(2 * sum(motion.startswith("builtin:") for motion in motions), len(motions))
        for name in PLANS:
            self.assertIn("version 1", (self.shipped / f"{name}.toml").read_text())

    def test_name_files_of_this_machine(self):
        plan = self.plan()
        for file in (plan["rig"], plan["settings_from"], *(each["rig"] for each in plan["variant"] if "rig" in each)):
            self.assertTrue(file.startswith("/") and REPOSITORY.joinpath(file).is_file(), file)

    def test_take_other_people(self):
        self.assertEqual(self.plan(people=3)["grid"]["twin"]["seed"], [FIRST_PERSON, FIRST_PERSON + 1, FIRST_PERSON + 2])
        self.assertEqual({tuple(grid["twin"]["seed"]) for grid in self.plan("benchmark_stress", people=2)["grid"]}, {(101, 102)})

    def test_get_the_row_of_a_method(self):
        with self.assertRaisesRegex(Problem, "there is no folder .*mine/benchmark"):
            Row("landmarks", self.folder / "mine", "mine")
        (self.folder / "mine/benchmark").mkdir(parents=True)
        row = Row("landmarks", self.folder / "mine", "mine")
        last = self.plan(row=row)["variant"][-1]
        self.assertEqual((last["name"], last["from"], last["landmarks"]), ("mine", ["handcast"], str(self.folder / "mine/benchmark")))
        self.assertNotIn("mine", [each["name"] for each in self.plan("benchmark_stress", row=row)["variant"]])
        with self.assertRaisesRegex(Problem, "--name"):
            Row("landmarks", self.folder / "mine", 'a "quoted" name')

    def test_of_the_images_have_one_variant(self):
        for name in PLANS:
            plan = self.plan(name, only_cases=True)
            self.assertNotIn("variant", plan)
            self.assertIn("grid", plan)


class TheTable(Test):
    def test_compares_case_by_case(self):
        file = write_sweep(self.folder, "benchmark", "twin.motion,twin.seed,interior_mm_mean,interior_mm_p95",
                           ["paper_at_our_speed,builtin:wave,101,4,9,", "paper_at_our_speed,/data/all_5s,101,10,20,",
                            "paper_at_our_speed,builtin:coin,101,6,9,", "mine,builtin:coin,101,3,5,",
                            "mine,builtin:wave,101,2,5,", "mine,/data/all_5s,101,15,20,"])
        paper, mine = rows_of(read_results([file]))
        self.assertEqual((paper["ratio"], paper["worse"]), (1, 0))
        self.assertEqual((mine["worse"], mine["compared"]), (1, 3))
        self.assertAlmostEqual(mine["ratio"], (2 / 4 + 15 / 10 + 3 / 6) / 3)
        self.assertEqual(mine["of_cases"], {"wave, 101": 2, "all_5s, 101": 15, "coin, 101": 3})
        self.assertIn("| mine | 6.7 / 10.0 | 0.83 | 1 of 3 |", list(markdown([paper, mine])))


    def test_has_a_dash_for_what_no_run_has(self):
        file = write_sweep(self.folder, "benchmark", "twin.motion,twin.seed,interior_mm_mean,interior_mm_p95",
                           ["paper_at_our_speed,builtin:wave,101,4,9,", "dark,builtin:wave,101,,,"])
        self.assertIn("| dark | – / – | – | 0 of 0 |", list(markdown(rows_of(read_results([file])))))


class TheProgram(Test):
    def setUp(self):
        super().setUp()
        self.plans = self.folder / "plans"
        self.plans.mkdir()
        for name, grid in TINY.items():
            (self.plans / f"{name}.toml").write_text(HEAD + "[grid]\n" + grid)

    def benchmark(self, *words):
        return self.run_program("benchmark", "--plans", self.plans, "--jobs", "2", *words)

    def test_gives_a_method_that_sends_what_ours_has_found_the_same_row(self):
        images, mine, out = self.folder / "images", self.folder / "mine", self.folder / "out"
        code, said, errors = self.benchmark("--images", images)
        self.assertEqual(code, 0, errors)
        self.assertIn("there is no folder /no/such/folder; left out", errors)
        for case in images.glob("benchmark*/0*"):
            self.assertTrue((case / "images.csv").is_file())
            (mine / case.parent.name).mkdir(parents=True, exist_ok=True)
            shutil.copy(case / "landmarks.csv", mine / case.parent.name / f"{case.name}.csv")
        code, said, errors = self.benchmark("--landmarks", mine, "--name", "my method", "--out", out)
        self.assertEqual(code, 0, errors)
        self.assertIn("| my method |", said)
        written = json.loads((out / "benchmark.json").read_text())
        self.assertEqual((written["benchmark"], written["planned_cases"]), (1, 2))
        rows = {row["name"]: row for row in written["rows"]}
        self.assertEqual(rows["my method"]["mean_mm"], rows["handcast"]["mean_mm"])
        self.assertEqual(rows["my method"]["cases"], 1)
        page = (out / "benchmark.html").read_text()
        self.assert_needs_no_network(page)
        self.assertEqual(page.count("<figure>"), 2, "charts A and B")
        self.assertIn("my method", page)

    def test_ends_its_sweep_when_it_is_ended(self):
        command = [program("benchmark"), "--plans", self.plans, "--out", self.folder / "out"]
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(process.kill)
        end = time.monotonic() + PATIENCE_S
        while not list(self.folder.glob("out/*.csv")):  # the sweep has begun
            self.assertLess(time.monotonic(), end)
            time.sleep(0.01)
        sweep, = pathlib.Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split()
        process.terminate()
        self.assertEqual(process.wait(PATIENCE_S), 128 + signal.SIGTERM)
        self.assertFalse(pathlib.Path(f"/proc/{sweep}").exists())

    def test_says_what_is_wrong(self):
        for words, why in ((["--people", "many"], "--people many: must be a whole number"),
                           (["--people", "0"], "--people 0: must be a whole number from 1 to"),
                           (["--jobs", "0"], "--jobs 0: must be a whole number from 1 to"),
                           (["--name", "ours"], "add --landmarks or --poses"),
                           (["--images", "a", "--poses", "b"], "--images scores nothing"),
                           (["--landmarks", "a", "--poses", "b"], "either of --landmarks or of --poses"),
                           (["--landmarks", self.folder], "there is no folder")):
            code, _, errors = self.benchmark(*words)
            self.assertEqual(code, 100)
            self.assertIn(why, errors)


if __name__ == "__main__":
    unittest.main()

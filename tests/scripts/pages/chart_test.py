#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""handcast chart."""
import argparse
import contextlib
import io
import re
import unittest
import xml.dom.minidom

from programs import REPOSITORY, Test
from sweeps import write_all, write_failures, write_hardware, write_ladder, write_stress, write_sweep

from pages import palette
from pages.chart import write
from pages.chart.analysis import breakdown_point, pareto_front, spread_apart
from pages.chart.chart_b_faults import chart_b_faults
from pages.chart.chart_hardware import lines_of as hardware_lines_of
from pages.chart.faults import failures_of
from pages.chart.hardware import Projector, pairs_of
from pages.chart.ladder import ladder_of
from pages.chart.picture import Range, range_of
from pages.chart.results import PLAIN_SETTINGS, mean_of, read_results
from pages.chart.stress import STRESSES, lines_of
from pages.files import Problem


class TheParetoFront(unittest.TestCase):
    def test_is_what_nothing_beats_by_ascending_x(self):
        self.assertEqual(pareto_front([(8, 4), (6, 14), (7, 2), (6.5, 15), (6.8, 5), (9, 1.9)]), [1, 4, 2, 5])

    def test_has_equal_points_which_do_not_beat_each_other(self):
        self.assertEqual(pareto_front([(1, 1), (1, 1)]), [0, 1])
        self.assertEqual(pareto_front([(1, 2), (1, 1)]), [1], "equal in x, smaller in y")
        self.assertEqual(pareto_front([]), [])


class TheBreakdownPoint(unittest.TestCase):
    def test_is_where_the_error_doubles_between_the_stresses_that_were_tried(self):
        self.assertEqual(breakdown_point([(5, 2), (10, 3), (20, 5), (40, 50)]), (15, 4))

    def test_is_the_first_of_several(self):
        self.assertEqual(breakdown_point([(0, 1), (1, 3), (2, 1), (3, 9)]), (0.5, 2))

    def test_is_nowhere_if_the_error_never_doubles_or_there_is_none_at_first(self):
        for points in ([(0, 1), (1, 1.9)], [(0, 0), (1, 5)], [(0, 1)], []):
            self.assertIsNone(breakdown_point(points))


class MarksThatAreSpreadApart(unittest.TestCase):
    def assert_spread(self, marks, gap, places):
        for place, wanted in zip(spread_apart(marks, gap, 0, 100), places, strict=True):
            self.assertAlmostEqual(place, wanted)

    def test_stay_where_they_have_room(self):
        self.assert_spread([50, 10, 30], 15, [50, 10, 30])

    def test_move_evenly_if_they_touch_and_keep_their_order(self):
        self.assert_spread([50, 52, 90], 10, [46, 56, 90])
        self.assert_spread([50, 50, 50], 10, [40, 50, 60])

    def test_stay_between_the_ends(self):
        self.assert_spread([1, 2, 3], 10, [0, 10, 20])
        self.assert_spread([99, 98], 10, [100, 90])


class AnAxis(unittest.TestCase):
    def test_has_round_tics_inside_its_range(self):
        self.assertEqual(Range(0, 10).tics(), [0, 2, 4, 6, 8, 10])
        self.assertEqual(Range(3.5, 130, True).tics(), [5, 10, 20, 50, 100])

    def test_holds_all_values(self):
        for is_log in (False, True):
            axis = range_of([3, 8, 5], is_log)
            self.assertTrue(axis.low < 3 and axis.high > 8)
            self.assertTrue(0 < axis.share(3) < axis.share(8) < 1)


class Results(Test):
    def fault_of(self, text):
        file = self.folder / "results.csv"
        file.write_text(text, encoding="utf-8")
        with self.assertRaises(Problem) as raised:
            read_results([file])
        return str(raised.exception)

    def test_have_the_settings_of_their_grid_and_the_metrics_that_were_measured(self):
        runs = read_results([write_stress(self.folder), write_failures(self.folder)]).runs
        self.assertEqual(len(runs), 11)
        self.assertEqual((runs[8].variant, runs[8].plan, runs[8].metrics["fault_worst_mm"]), ("handcast", "failures", 30))
        self.assertNotIn("fault_recovery_ms", runs[8].metrics, "the run has no recovery")
        self.assertEqual(runs[8].turned(), ["twin.tracker.lost_at_s", "twin.tracker.lost_s"])
        self.assertEqual(runs[9].turned(), ["twin.image.dark"], "empty cells are not axes")

    def test_have_means_of_the_runs_that_have_the_figure(self):
        runs = read_results([write_failures(self.folder)]).runs
        self.assertEqual(mean_of(runs, "fault_worst_mm"), 45)
        self.assertIsNone(mean_of(runs, "nonsense"))

    def test_leave_out_failed_runs_and_count_them(self):
        rows = ["a,1,2,", 'a,2,,"it broke, twice"']
        results = read_results([write_sweep(self.folder, "some", "twin.speed,interior_mm_p95", rows)])
        self.assertEqual((len(results.runs), results.sources[0].failed), (1, 1))

    def test_have_settings_of_no_section(self):
        results = read_results([write_sweep(self.folder, "some", "calibration,iou", ["a,ours.toml,0.9,"])])
        self.assertEqual(results.runs[0].turned(), ["calibration"])
        reference = (REPOSITORY / "config/REFERENCE.md").read_text(encoding="utf-8")
        table = reference.partition("## The file itself")[2].partition("\n## [")[0]
        self.assertEqual(tuple(re.findall(r"^\| `(\w+)`", table, re.MULTILINE)), PLAIN_SETTINGS, "all of config/REFERENCE.md")

    def test_leave_out_the_line_at_which_a_sweep_was_cut_off(self):
        file = write_sweep(self.folder, "some", "twin.speed,iou", ["a,1,0.5,", "a,2,0.6,"])
        file.write_text(file.read_text(encoding="utf-8")[:-3], encoding="utf-8")
        self.assertEqual(len(read_results([file]).runs), 1)

    def test_of_no_sweep_are_told_in_a_sentence(self):
        stamp = "# handcast sweep version=1 runs=1 plan=x\n"
        no_sweep = "results.csv: the file does not hold results of a sweep"
        for text in ("", "a,b\n1,2\n", f"{stamp}a,b,c\n", stamp.replace("runs=1", "runs=0"), stamp.replace("runs=1", "runs=99999999999")):
            self.assertIn(no_sweep, self.fault_of(text))
        self.assertIn("results.csv: the file has no scored run", self.fault_of(f"{stamp}index,variant,iou,error\n"))
        self.assertIn("results.csv:3: the line is not one of this sweep", self.fault_of(f"{stamp}index,variant,iou,error\n0,a\n"))
        for word in ("much", "nan", "inf", "1e999", "1_0", "0x1"):
            self.assertIn(f"results.csv: run 0: iou is '{word}', which is not a number",
                          self.fault_of(f"{stamp}index,variant,iou,error\n0,a,{word},\n"))
        with self.assertRaisesRegex(Problem, "nowhere.csv: cannot be read"):
            read_results([self.folder / "nowhere.csv"])


class TheLadder(Test):
    def test_has_frame_times_of_the_plan_that_measures_them_alone(self):
        files = write_all(self.folder)
        self.assertFalse(ladder_of(read_results(files)).timed_alone)
        files.append(write_sweep(self.folder, "times", "twin.speed,interior_mm_p95,frame_us_p50", ["handcast,1,99,555,"]))
        ladder = ladder_of(read_results(files))
        self.assertTrue(ladder.timed_alone)
        ours = next(standing for standing in ladder.at(1) if standing.method.is_ours)
        self.assertEqual((ours.frame_us, ours.p95_mm), (555, 2.1), "the errors are those of the ladder")

    def test_has_methods_at_the_time_of_their_own_frames_and_the_paper_at_its_own(self):
        columns = "twin.speed,interior_mm_p95,motion_to_photon_ms,software_ms,frame_us_p50"
        files = [write_sweep(self.folder, "ladder", columns, ["shift,1,5,6.9,1.2,9999,", "paper,1,4,8.9,3.19,9999,",
                                                              "ideal,1,4,6.9,1.2,9999,", "handcast,1,4,6.9,1.2,9999,"]),
                 write_sweep(self.folder, "times", columns, ["shift,1,5,6.9,1.2,700,", "paper,1,4,8.9,3.19,1900,",
                                                             "handcast,1,4,6.9,1.2,1000,"])]
        photons_ms = [standing.photon_ms for standing in ladder_of(read_results(files)).at(1)]
        for photon_ms, wanted_ms in zip(photons_ms, (6.4, 8.9, 6.7, 6.7), strict=True):  # "ideal" has the frame time of handcast
            self.assertAlmostEqual(photon_ms, wanted_ms)


class StressesAndFailures(Test):
    def setUp(self):
        super().setUp()
        self.results = read_results(write_all(self.folder))

    def test_a_stress_is_the_mean_over_seeds_and_has_a_breakdown(self):
        paper, ours = lines_of(self.results, STRESSES[0])
        self.assertEqual(paper.points[0][1], 3, "mean of seeds 1 and 2")
        self.assertEqual(paper.breakdown[0], 15)
        self.assertIsNone(ours.breakdown)

    def test_the_atlas_tells_what_passes_from_what_stays_and_who_never_recovers(self):
        failures = failures_of(self.results)
        self.assertEqual([failure.name for failure in failures],
                         ["tracker silent, 200 ms", "image dark: 50 % of the light", "cross fingers"])
        self.assertEqual(failures[0].damage["paper"].recovery_ms, 73)
        self.assertEqual(failures[0].damage["handcast"].never_good, 1)

    def test_the_atlas_says_where_the_papers_cascade_recovers_faster(self):
        figures = "builtin:wave,4,0.9,0.1,0,60,20"
        file = write_sweep(
            self.folder, "failures",
            "twin.tracker.frozen_at_s,twin.tracker.frozen_s,twin.detector.lost_at_s,twin.detector.lost_s,twin.motion,interior_mm_p95,"
            "coverage,spill,foldovers,fault_worst_mm,fault_dark_ms,fault_recovery_ms",
            [f"paper,1,0.6,,,{figures},73,", f"handcast,1,0.6,,,{figures},80,",
             f"paper,1,0.2,,,{figures},73,", f"handcast,1,0.2,,,{figures},74,",
             f"paper,1,0.6,1,0.3,{figures},,", f"handcast,1,0.6,1,0.3,{figures},90,"])
        results = read_results([file])
        self.assertEqual(failures_of(results)[2].name, "landmarks lost, 300 ms + tracker frozen, 600 ms")
        self.assertIn("recovers faster than ours in 1 of 3 failures (tracker frozen, 600 ms: 73 ms, ours 80 ms).",
                      chart_b_faults(results).reading)


class Drawn(Test):
    """A test that draws charts, in this process."""

    def draw(self, *files, title="a title"):
        """Draws into `out`, and returns what is said on stderr."""
        self.out = self.folder / "deep" / "charts"
        said = []
        with contextlib.redirect_stdout(io.StringIO()) as output:
            exit_code = write.run(argparse.Namespace(results=files, out=self.out, title=title), lambda _, sentence: said.append(sentence))
        self.assertEqual((exit_code, output.getvalue()), (0, f"{self.out}/charts.html\n"))
        return said

    def text_of(self, name):
        return (self.out / name).read_text(encoding="utf-8")


class AllCharts(Drawn):
    def test_are_on_a_page_that_needs_nothing_else_in_the_colours_of_both_schemes(self):
        self.assertEqual(self.draw(*write_all(self.folder), title="a <title>"), [])
        page = self.text_of("charts.html")
        for name in ("chart_a", "chart_b", "chart_b_faults", "chart_c", "hardware"):
            self.assertIn(f'<section id="{name}">', page)
        self.assertEqual(page.count('<img alt="'), 5)
        self.assertEqual(page.count('<source media="(prefers-color-scheme: dark)" srcset="data:image/svg+xml;base64,'), 5)
        self.assertIn("<h1>a &lt;title&gt;</h1>", page)
        self.assert_needs_no_network(page)
        self.assert_colours_of_both_schemes(page)
        self.assert_points_of_chart_a()
        self.assert_numbers_of_charts_b_and_c()

    def assert_colours_of_both_schemes(self, page):
        self.assertIn(f"--ours: {palette.DARK['ours']}", page)
        drawing = self.text_of("chart_a.svg")
        self.assertIn(palette.LIGHT["ours"], drawing)
        self.assertNotIn(palette.DARK["ours"], drawing)
        self.assertEqual(palette.LIGHT.keys(), palette.DARK.keys())

    def assert_points_of_chart_a(self):
        numbers = self.text_of("chart_a.csv").splitlines()
        self.assertIn("natural speed,paper as published,cpu,8.9,4,2,,,,,1900,,1", numbers)
        self.assertIn("natural speed,shift,cpu,6.3,5,3,,,,,760,yes,1", numbers)
        self.assertIn("3 times as fast,handcast,cpu,6.8,6.3,1,,,,,1000,yes,1", numbers)
        for words in ("natural speed", "3 times as fast", "paper as published\u20024.0", ">3.08<"):
            self.assertIn(words, self.text_of("chart_a.svg"))

    def assert_numbers_of_charts_b_and_c(self):
        self.assertIn("tracker age,ms,20,15,\n", self.text_of("chart_b_breakdown.csv"))
        self.assertIn('"tracker silent, 200 ms",for a moment,handcast,30,not within the run,yes,10', self.text_of("chart_b_faults.csv"))
        numbers = self.text_of("chart_c.csv").splitlines()
        for row in ("natural speed,hold,0,7,14,,700", "natural speed,handcast,55,1,2.1,,1000"):
            self.assertIn(row, numbers)
        self.assertNotIn("paper", self.text_of("chart_c.csv"))


class Hardware(Drawn):
    def test_has_a_pair_for_each_method_camera_projector_and_speed(self):
        pairs = pairs_of(read_results([write_hardware(self.folder), write_stress(self.folder)]))
        self.assertEqual(len(pairs), 16, "those of other plans are none")
        pair, = (pair for pair in pairs if (pair.method.variant, pair.camera_hz, pair.projector, pair.speed) ==
                 ("paper", 60, Projector(60, 50), 3))
        self.assertEqual((pair.mean_mm, pair.runs), (13.5, 2), "the mean of two seeds")

    def test_is_drawn_by_camera_from_the_slowest_projector_to_the_fastest(self):
        pairs = pairs_of(read_results([write_hardware(self.folder)]))
        lines = hardware_lines_of(pairs, 1)
        self.assertEqual([(line.method.variant, line.camera_hz) for line in lines],
                         [("paper", 60), ("paper", 525), ("handcast", 60), ("handcast", 525)])
        self.assertEqual(lines[-1].points([Projector(60, 50), Projector(946, 3)]), [(0, 8.5), (1, 5.5)])

    def test_has_its_numbers_in_a_file(self):
        self.draw(write_hardware(self.folder))
        self.assertIn('natural speed,handcast,525,"60 Hz, 50 ms",8.5,12,0.1,-0.5,7.5,2', self.text_of("hardware.csv").splitlines())
        for words in ("natural speed", "3 times as fast", ">946 Hz<", ">50 ms<"):
            self.assertIn(words, self.text_of("hardware.svg"))


class AChart(Drawn):
    def test_is_the_same_picture_if_the_results_are_the_same(self):
        files = [write_stress(self.folder)]
        self.draw(*files)
        first = self.text_of("chart_b.svg")
        self.draw(*files)
        self.assertEqual(first, self.text_of("chart_b.svg"))

    def test_names_the_age_of_a_real_detector(self):
        columns = "twin.speed,interior_mm_mean,interior_mm_p95,motion_to_photon_ms,software_ms,frame_us_p50,detector_age_ms"
        rows = ["handcast,1,1,2,6.9,1.2,9999,16.2,", "handcast_network,1,2,4,6.9,1.2,9999,4.1,"]
        times = ["handcast,1,1,2,6.9,1.2,1000,16.2,"]
        self.draw(write_sweep(self.folder, "ladder", columns, rows), write_sweep(self.folder, "times", columns, times))
        self.assertIn("natural speed,with our network,cpu,6.7,4,2,,,,4.1,", self.text_of("chart_a.csv"))
        self.assertIn("with our network, 4 ms old\u20024.0", self.text_of("chart_a.svg"))

    def test_leaves_a_cell_empty_where_a_method_has_no_level_and_the_others_in_their_rows(self):
        rows = ["paper,5,3,", "paper,10,,", "paper,20,7,", "handcast,10,1.1,", "handcast,20,1.9,", "handcast,40,2.5,"]
        self.draw(write_sweep(self.folder, "stress", "twin.tracker.age_ms,interior_mm_mean", rows))
        harm = ',ms,"interior error, mean, mm",'
        self.assertEqual(self.text_of("chart_b.csv").splitlines()[1:],
                         [f"tracker age,5{harm}3,", f"tracker age,10{harm},1.1", f"tracker age,20{harm}7,1.9", f"tracker age,40{harm},2.5"])

    def test_that_cannot_be_drawn_is_named_and_the_rest_is_drawn(self):
        said = self.draw(write_stress(self.folder))
        self.assertEqual([line.partition(" needs ")[0] for line in said], ["chart_a", "chart_b_faults", "chart_c", "hardware"])
        self.assertIn("Not drawn: the chart needs drawn runs", self.text_of("charts.html"))
        self.assertFalse((self.out / "chart_a.svg").exists())

    def test_needs_a_column_that_the_results_have(self):
        with self.assertRaisesRegex(Problem, "^no chart can be drawn.*interior_mm_p95"):
            self.draw(write_sweep(self.folder, "odd", "twin.speed,iou", ["a,1,0.5,"]))
        self.assertFalse(self.out.exists())

    def test_has_names_of_methods_as_they_are(self):
        for name in ("$\\frac{$", "`touch planted`", "'<b>&", "\x1b[31m", "𝄞 ½"):
            self.draw(write_sweep(self.folder, "ladder", "twin.speed,motion_to_photon_ms,interior_mm_p95", [f'"{name}",1,7,2,']))
            self.assertNotIn("<b>", self.text_of("charts.html"))
            texts = xml.dom.minidom.parse(str(self.out / "chart_a.svg")).getElementsByTagName("text")
            self.assertIn(name.replace("\x1b", " ").split()[0], " ".join(text.firstChild.data for text in texts))


class TheProgram(Test):
    def test_takes_its_options_in_any_order(self):
        out = self.folder / "charts"
        done = self.run_program("chart", write_ladder(self.folder), f"--out={out}", write_stress(self.folder), "--title", "ours")
        self.assertEqual(done[:2], (0, f"{out}/charts.html\n"))
        self.assertEqual(done[2].count("handcast chart: chart_b_faults needs"), 1)
        self.assertIn("<title>ours</title>", (out / "charts.html").read_text(encoding="utf-8"))

    def test_explains_itself(self):
        exit_code, output, _ = self.run_program("chart", "--help")
        self.assertEqual(exit_code, 0)
        for words in ("--out", "--title", "RESULTS.csv", "scripts/charts runs all of them"):
            self.assertIn(words, output)
        self.assertRegex(self.run_program("chart", "--version")[1], r"^handcast chart \d+\.\d+\.\d+\n$")

    def test_refuses_a_command_line_in_one_sentence_with_exit_code_2(self):
        usage = "; `handcast help chart`\n"
        for words, sentence in (([], "RESULTS.csv is required"), (["a.csv", "--out"], "--out needs a value"), ([""], "argument 1 is empty"),
                                (["a.csv", "--ouut=x"], "unknown option '--ouut=x' (did you mean '--out'?)"),
                                (["a.csv", "--titl=x"], "unknown option '--titl=x' (did you mean '--title'?)")):
            self.assertEqual(self.run_program("chart", *words), (2, "", f"handcast chart: {sentence}{usage}"))

    def test_ends_with_100_for_a_file_that_is_no_sweep(self):
        exit_code, _, errors = self.run_program("chart", REPOSITORY / "CMakeLists.txt", "--out", self.folder)
        self.assertEqual(exit_code, 100)
        self.assertIn("CMakeLists.txt: the file does not hold results of a sweep", errors)

    def test_ends_with_111_if_the_output_cannot_be_written(self):
        exit_code, _, errors = self.run_program("chart", write_ladder(self.folder), "--out", "/proc/self/nothing")
        self.assertEqual(exit_code, 111)
        self.assertIn("/proc/self/nothing: the folder cannot be made", errors)


if __name__ == "__main__":
    unittest.main()

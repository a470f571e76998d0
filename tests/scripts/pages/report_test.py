#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""handcast report."""
import argparse
import contextlib
import html
import io
import json
import os
import re
import stat
import unittest

import programs
from demonstration import live_run, metrics_of, write_demonstration, write_frames, write_json

from pages.document import figure
from pages.files import Problem, read_input, write_whole
from pages.report import write
from pages.report.film import framed
from pages.report.live import STAGES


class Report(programs.Test):
    def page(self, title="a title"):
        """Makes a report in this process, and returns its page. What is wrong with its files is in `faults`."""
        self.faults = []
        with contextlib.redirect_stdout(io.StringIO()):
            exit_code = write.run(argparse.Namespace(out=self.folder, title=title), lambda _, fault: self.faults.append(fault))
        self.assertEqual(exit_code, 1 if self.faults else 0)
        return (self.folder / "report.html").read_text(encoding="utf-8")

    def metrics(self):
        return json.loads((self.folder / "metrics.json").read_text(encoding="utf-8"))


class TheReport(Report):
    def test_shows_figures_film_times_and_rates_and_needs_nothing_from_outside(self):
        write_demonstration(self.folder, 6)
        page = self.page()
        for shown in ("16.72", "4.03", "2.66",            # p95 in mm of the three
                      "data:image/jpeg;base64,/9j/",      # stills
                      "498.2", "95 %",                    # a rate and its share
                      "0.6-1.0", "builtin:open_close", "<b>detect</b>"):
            self.assertIn(shown, page)
        self.assertNotIn("&gt;1.0", page, "a bin without frames")
        self.assertNotIn('class="missing"', page)
        self.assert_needs_no_network(page)
        self.assertIn("prefers-color-scheme: dark", page)

    def test_gathers_the_figures_of_all_runs_in_one_file(self):
        write_demonstration(self.folder, 0)
        self.page()
        metrics = self.metrics()
        self.assertEqual(metrics["baseline"]["interior_mm"]["mean"], 7.6)
        self.assertEqual([metrics["paper"]["rig"], metrics["handcast"]["rig"]], ["paper", "twin"])
        self.assertEqual(metrics["live"]["rates"]["camera"]["held_hz"], 498.21)
        self.assertEqual(metrics["live"]["observer"]["interior_mm"]["mean"], 1.3)

    def test_prints_the_best_value_of_a_row_in_bold(self):
        for name, coverage, latency_ms in (("baseline", 0.9, -5), ("paper", 0.8, 1), ("twin", 0.95, -0.5)):
            write_json(self.folder / f"{name}.json", {"coverage": coverage, "equivalent_latency_ms": latency_ms, "spill": 0.1})
        page = self.page()
        self.assertIn('<td>90.00</td><td>80.00</td><td class="best">95.00</td>', page)
        self.assertIn('<td>-5.00</td><td>1.00</td><td class="best">-0.50</td>', page)
        self.assertIn("<td>10.00</td><td>10.00</td><td>10.00</td>", page, "none is best")

    def test_says_if_the_computer_was_too_slow_for_the_live_rig(self):
        live = live_run()
        write_json(self.folder / "live.json", live)
        self.assertNotIn("too slow", self.page())
        live["rates"]["projector"]["held_hz"] = 321.0
        write_json(self.folder / "live.json", live)
        self.assertIn("too slow for the requested rates and held 34 % of one of them", self.page())
        live["services"]["projector"]["is_held_to_its_rate"] = False
        write_json(self.folder / "live.json", live)
        self.assertNotIn("too slow", self.page(), "sub-frames")

    def test_says_what_made_the_slowest_frames_slow(self):
        live = live_run()
        write_json(self.folder / "live.json", live)
        self.assertIn("Of the 100 slowest frames of projector (1.91 ms or more), 61 were preempted by other threads, 20 by interrupts",
                      self.page())
        live["slow_frames"]["projector2"] = {"count": 7}
        write_json(self.folder / "live.json", live)
        self.assertIn("Of the 7 slowest frames of projector2 (", self.page())
        live["slow_frames"] = {}
        write_json(self.folder / "live.json", live)
        self.assertNotIn("slowest frames", self.page())

    def test_says_which_detector_each_run_had_and_why(self):
        detectors = {"baseline": (False, "twin", None), "paper": (True, "twin", "'a.onnx' is missing"), "twin": (True, "handcast", None)}
        for name, (used, backend, why) in detectors.items():
            detector = {"used": used, "backend": backend, "age_ms": 16.2, "why": why}
            write_json(self.folder / f"{name}.json", metrics_of(name, 1) | {"detector": detector})
        page = self.page()
        self.assertIn("Landmarks</th><td>not used</td><td>twin, 16.2 ms old</td><td>handcast, 16.2 ms old</td>", page)
        self.assertIn("paper: &#39;a.onnx&#39; is missing.", page)

    def test_says_what_the_method_gains_apart_from_the_time_of_its_software(self):
        write_json(self.folder / "equal_legs.json", metrics_of("twin", 1) | {"software_ms": 3.19})
        write_json(self.folder / "twin.json", metrics_of("twin", 1))
        self.assertIn("With the 3.19 ms of the paper, handcast has a p95 of <b>2.20 mm</b>", self.page())

    def test_makes_a_film_of_the_pictures_that_it_has(self):
        write_frames(self.folder / "frames" / "twin", 6, 0)
        page = self.page()
        self.assertIn(b"ftyp", (self.folder / "preview.mp4").read_bytes()[:12])
        self.assertTrue((self.folder / "preview.png").exists())
        for name, is_missing in (("baseline", True), ("paper", True), ("handcast", False)):
            self.assertEqual(f"no pictures of {name} in frames/" in page, is_missing)

    def test_goes_on_without_a_film_that_cannot_be_written(self):
        write_frames(self.folder / "frames" / "twin", 1, 0)
        os.mkfifo(self.folder / "preview.mp4")
        self.assertIn("preview.mp4: cannot be written: it is a pipe, not a file", self.page())

    def test_says_what_is_missing_and_shows_the_rest(self):
        write_json(self.folder / "twin.json", metrics_of("twin", 1.21))
        (self.folder / "paper.json").write_text('{ "interior', encoding="utf-8")
        page = self.page()
        for shown in ("baseline.json is missing", "paper.json is not a JSON object", "live.json is missing", "2.66"):
            self.assertIn(shown, page)
        self.assertNotIn("baseline", self.metrics())
        self.assertFalse((self.folder / "preview.mp4").exists())

    def test_escapes_what_it_did_not_write_itself(self):
        write_json(self.folder / "twin.json", metrics_of("<b>rig</b>", 1) | {"motion": '"><script>alert(1)</script>{{ title }}'})
        page = self.page(title="R&D <report>")
        self.assertIn("<title>R&amp;D &lt;report&gt;</title>", page)
        self.assertIn("&lt;b&gt;rig", page)
        self.assertNotIn("<script", page)
        self.assertIn("&lt;/script&gt;{{ title }}", page, "values are no templates")

    def test_is_an_error_for_a_folder_without_its_files(self):
        with self.assertRaisesRegex(Problem, f"'{self.folder}' has nothing to report: .*twin.json.*live.json"):
            self.page()
        self.folder = self.folder / "nowhere"
        with self.assertRaisesRegex(Problem, "nowhere' is not a folder"):
            self.page()

    def test_names_all_stages_in_their_order(self):
        header = (programs.REPOSITORY / "ipc/msg/stage_mark.hpp").read_text(encoding="utf-8")
        names = re.findall(r'"(\w+)"', header.partition("kStageNames{")[2].partition("}")[0])
        frame, sensors = STAGES[0][2], STAGES[1][2]
        self.assertEqual(names, [*sensors, "watch", "bridge", *frame])


class Figures(Report):
    def fault_of(self, name, content):
        """What is wrong with a file with this text; it must be on the page."""
        (self.folder / name).write_text(content if isinstance(content, str) else json.dumps(content), encoding="utf-8")
        page = self.page()
        (self.folder / name).unlink()
        for fault in self.faults:
            self.assertIn(html.escape(fault), page)
        return "; ".join(self.faults)

    def test_of_the_wrong_kind_are_named_and_not_shown(self):
        write_json(self.folder / "live.json", live_run())
        for name, content, fault in (
                ("twin.json", {"coverage": None, "interior_mm": {"p95": 1}}, ""),
                ("twin.json", {"interior_mm": "none"}, "twin.json: /interior_mm must be an object"),
                ("twin.json", {"interior_mm": {"p95": "1"}}, "twin.json: /interior_mm/p95 must be a number"),
                ("twin.json", {"coverage": True}, "twin.json: /coverage must be a number"),
                ("twin.json", {"bins": [1, 2]}, "twin.json: /bins must be an object"),
                ("twin.json", {"bins": {"0-1": 3}}, "twin.json: /bins/0-1 must be an object"),
                ("twin.json", {"motion": 5}, "twin.json: /motion must be a text"),
                ("paper.json", {"stage_us": {"skin": {"p50": True}}}, "paper.json: /stage_us/skin/p50 must be a number"),
                ("observer.json", {"frame_us": 3}, "observer.json: /frame_us must be an object")):
            self.assertEqual(self.fault_of(name, content), fault)

    def test_that_are_no_json_are_not_read(self):
        write_json(self.folder / "live.json", live_run())
        deep = '{"a":' + 1_000_000 * "[" + 1_000_000 * "]" + "}"
        for text in ("", "[]", '{"coverage": NaN}', '{"coverage": 1e999}', '{"motion": "\\ud800"}', deep, '{"a":' + 40 * "[" + 40 * "]" + "}"):
            self.assertEqual(self.fault_of("twin.json", text), "twin.json is not a JSON object")

    def test_of_very_many_digits_are_numbers(self):
        write_json(self.folder / "live.json", live_run())
        self.assertEqual(self.fault_of("twin.json", '{"frames": ' + 300 * "9" + ', "interior_mm": {"mean": ' + 5000 * "1" + "}}"),
                         "twin.json is not a JSON object")
        self.assertEqual(self.fault_of("twin.json", '{"interior_mm": {"mean": ' + 300 * "9" + "}}"), "")

    def test_have_a_dash_if_they_are_missing(self):
        self.assertEqual([figure(value, 1) for value in (None, float("nan"), 0, 2.25)], ["–", "–", "0.0", "2.2"])


class TheFrameOfTheFilm(unittest.TestCase):
    def test_holds_all_moving_parts_and_stays_in_the_picture(self):
        left, top, width, height = framed([(100, 200, 180, 300), (150, 250, 260, 320)], 1024, 768)
        self.assertTrue(left <= 100 and top <= 200 and left + width >= 260 and top + height >= 320)
        self.assertAlmostEqual(width / height, 4 / 3, delta=0.02)
        self.assertTrue(all(value >= 0 for value in framed([(0, 0, 30, 30)], 1024, 768)))

    def test_is_the_whole_picture_if_nothing_moves_or_everything(self):
        self.assertEqual(framed([], 1024, 768), (0, 0, 1024, 768))
        self.assertEqual(framed([(0, 0, 1000, 700)], 1024, 768), (0, 0, 1024, 768))


class Files(programs.Test):
    def test_are_replaced_as_a_whole_and_keep_their_permissions(self):
        file, link = self.folder / "a", self.folder / "link"
        file.write_bytes(b"old")
        file.chmod(0o640)
        link.symlink_to(file)
        write_whole(link, b"new")
        self.assertEqual((file.read_bytes(), stat.S_IMODE(file.stat().st_mode), link.is_symlink()), (b"new", 0o640, True))
        self.assertEqual(sorted(self.folder.iterdir()), [file, link])

    def test_that_cannot_be_written_are_as_before(self):
        with self.assertRaisesRegex(Problem, "cannot be written") as raised:
            write_whole(self.folder / "absent" / "a", b"new")
        self.assertTrue(raised.exception.may_pass)
        with self.assertRaisesRegex(Problem, "it is a folder, not a file"):
            write_whole(self.folder, b"new")

    def test_are_not_read_if_they_are_none_or_too_large(self):
        os.mkfifo(self.folder / "pipe")
        for name, words in (("pipe", "it is a pipe, not a file"), (".", "it is a folder, not a file"), ("absent", "No such file")):
            with self.assertRaisesRegex(Problem, words):
                read_input(self.folder / name, 10)
        (self.folder / "large").write_bytes(11 * b"a")
        with self.assertRaisesRegex(Problem, "has more than"):
            read_input(self.folder / "large", 10)


class TheProgram(programs.Test):
    def test_prints_the_page_and_ends_with_1_if_a_file_cannot_be_used(self):
        write_json(self.folder / "twin.json", metrics_of("twin", 1))
        done = self.run_program("report", f"--out={self.folder}", "--title", "ours")
        self.assertEqual(done, (0, f"{self.folder}/report.html\n", ""))
        self.assertIn("<title>ours</title>", (self.folder / "report.html").read_text(encoding="utf-8"))
        (self.folder / "live.json").write_text("{", encoding="utf-8")
        done = self.run_program("report", "--out", self.folder)
        self.assertEqual(done, (1, f"{self.folder}/report.html\n", "handcast report: live.json is not a JSON object\n"))

    def test_ends_with_2_100_or_111_and_one_sentence(self):
        self.assertEqual(self.run_program("report"), (2, "", "handcast report: --out is required; `handcast help report`\n"))
        self.assertEqual(self.run_program("report", "--out=x", "y"),
                         (2, "", "handcast report: 'y' is one argument too many; `handcast help report`\n"))
        self.assertEqual(self.run_program("report", "--out=/nowhere\x1b"), (100, "", "handcast report: '/nowhere ' is not a folder\n"))
        write_json(self.folder / "twin.json", metrics_of("twin", 1))
        with open("/dev/full", "w", encoding="utf-8") as full:
            program = [programs.program("report"), f"--out={self.folder}"]
            done = programs.subprocess.run(program, stdout=full, stderr=programs.subprocess.PIPE, check=False, timeout=programs.PATIENCE_S)
        self.assertEqual((done.returncode, done.stderr),
                         (111, b"handcast report: the output cannot be written: No space left on device\n"))

    def test_explains_itself_without_the_packages_of_its_pages(self):
        self.assertIn("--out DIR", self.run_program("report", "--help")[1])
        hidden = self.folder / "bin"
        hidden.mkdir()
        program = hidden / "handcast-report"
        text = programs.program("report").read_text(encoding="utf-8")
        program.write_text(text.replace("import sys\n", "import sys\nsys.modules['cv2'] = None\n"), encoding="utf-8")
        program.chmod(0o755)
        (self.folder / "share/handcast").mkdir(parents=True)
        (self.folder / "share/handcast/pages").symlink_to(programs.REPOSITORY / "scripts/pages")
        done = programs.subprocess.run([program, "--out=."], capture_output=True, text=True, check=False, timeout=programs.PATIENCE_S)
        self.assertEqual((done.returncode, done.stderr),
                         (100, "handcast report: the package python3-opencv is missing; `scripts/setup --pages` installs it\n"))


if __name__ == "__main__":
    unittest.main()

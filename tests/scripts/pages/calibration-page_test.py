#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""handcast-calibration-page, which `handcast calibrate` calls."""
import argparse
import contextlib
import io
import json
import math
import unittest

import programs
from calibration_session import STEPS, picture, write_session

from pages.calibration import write
from pages.calibration.pictures import drawn
from pages.calibration.write import sentence
from pages.files import Problem


class CalibrationPage(programs.Test):
    def page(self):
        """Makes the page of the folder in this process, and returns it."""
        with contextlib.redirect_stdout(io.StringIO()):
            self.assertEqual(write.run(argparse.Namespace(folder=self.folder), None), 0)
        return (self.folder / "report.html").read_text(encoding="utf-8")


class ThePage(CalibrationPage):
    def test_shows_each_step_with_its_pictures_and_needs_nothing_from_outside(self):
        write_session(self.folder, list(STEPS))
        page = self.page()
        for shown in ("Lens of the camera", "focal length 1161.9 px ± 0.32 %", "<li>Image 15 was left out. Its error is large.</li>",
                      "Held out: good is at most 0.6 px. ±: with 95 % probability.", "The frame is the image, 720 x 540 px.",
                      '<th scope="row">middle</th><td>0</td><td>0</td><td>0.73</td><td>0.6</td><td>1.5</td>'):
            self.assertIn(shown, page)
        self.assertEqual(page.count("data:image/svg+xml"), 2 * 7, "seven pictures, light and dark")
        self.assertIn("prefers-color-scheme: dark", page)
        self.assert_needs_no_network(page)

    def test_says_first_what_is_missing(self):
        write_session(self.folder, ["lens", "light"], rig_file="my <rig>.toml")
        page = self.page()
        self.assertIn("Not measured yet: <code>screen</code>, <code>tracker</code>. Go on with "
                      "<code>handcast calibrate my &lt;rig&gt;.toml</code>", page)
        self.assertIn("<td>not measured yet</td>", page)
        self.assertIn("<td>measured, see below</td>", page, "the light is no part of the calibration file")
        self.assertLess(page.index("Not measured yet"), page.index("Lens of the camera"))
        self.assertNotIn('<section id="screen">', page)

    def test_says_what_to_do_when_all_is_measured(self):
        write_session(self.folder, list(STEPS))
        page = self.page()
        self.assertIn("All steps are measured. <code>handcast doctor my_rig.toml</code>", page)
        self.assertIn("<code>handcast calibrate my_rig.toml --check</code>", page)

    def test_names_the_board_and_the_folder_of_the_session_in_its_commands(self):
        other = {"board": "charuco:11x8:25", "folder": "a <folder>"}
        write_session(self.folder, [], **other)
        self.assertIn("<code>handcast calibrate my_rig.toml --board charuco:11x8:25 --folder a &lt;folder&gt;</code>", self.page())
        write_session(self.folder, list(STEPS), **other)
        self.assertIn("<code>handcast calibrate my_rig.toml --check --board charuco:11x8:25</code>", self.page())

    def test_names_no_step_that_the_rig_has_no_need_of(self):
        write_session(self.folder, ["lens"], ("lens", "screen"))
        self.assertNotIn("tracker", self.page())


class ASentence(unittest.TestCase):
    def test_begins_and_ends_as_one(self):
        for text, whole in (("was the board still?", "Was the board still?"), ("look. At it", "Look. At it."), ("0.1 px +- 2", "0.1 px ± 2."),
                            ("projector.gamma was 2.2", "projector.gamma was 2.2."), ("", "")):
            self.assertEqual(sentence(text), whole)


class APicture(unittest.TestCase):
    def test_is_drawn_although_a_number_is_missing(self):
        for left_out in ([0, 0], [0, 1]):
            self.assertIn("data:", drawn("bars", "", {"rms_px": [0.1, math.nan], "is_left_out": left_out}).light_url)
        empty = {"rms_px": [], "is_left_out": []}
        self.assertIn("data:", drawn("bars", "", empty).dark_url)

    def test_of_an_unknown_kind_or_without_its_numbers_is_refused(self):
        for kind, numbers in (("film", {}), ("dots", {"size_px": [720, 540]}), ("places", {}), ("depths", {"grid": [2]})):
            with self.assertRaises(Problem):
                drawn(kind, "", numbers)


class TheProgram(CalibrationPage):
    def test_ends_with_100_and_one_sentence(self):
        self.assertEqual(self.run_program("calibration-page")[0], 2)
        exit_code, _, error = self.run_program("calibration-page", "--folder", self.folder)
        self.assertEqual((exit_code, error), (100, f"handcast calibration-page: {self.folder}/report.json: cannot be read: No such file or "
                                                   "directory\n"))
        write_session(self.folder, ["lens"])
        for damage in ("{", "[]", "{}", json.dumps({"made": "", "findings": [], "meaning": "", "pictures": [picture("dots", "")]})):
            (self.folder / "lens.json").write_text(damage, encoding="utf-8")
            exit_code, _, error = self.run_program("calibration-page", "--folder", self.folder)
            self.assertEqual((exit_code, error.count("\n")), (100, 1), error)
            self.assertIn("measure", error)
        self.assertFalse((self.folder / "report.html").exists())

    def test_writes_the_page(self):
        write_session(self.folder, ["lens"])
        file = self.folder / "report.html"
        self.assertEqual(self.run_program("calibration-page", "--folder", self.folder), (0, f"{file}\n", ""))
        self.assertTrue(file.exists())


if __name__ == "__main__":
    unittest.main()

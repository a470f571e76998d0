#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The unit that reboots as a last resort does so at most once a day. usage: reboot_test.py"""
import os
import pathlib
import re
import shlex
import subprocess
import tempfile
import time
import unittest

UNITS = pathlib.Path(__file__).resolve().parents[3] / "supervisor/succession/units"


class Reboot(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)
        self.request = self.folder / "gives-up"
        self.last = self.folder / "state/last"
        self.last.parent.mkdir()
        (self.folder / "bin").mkdir()
        (self.folder / "bin/systemctl").write_text(f"#!/bin/sh\necho \"$@\" >>{self.folder}/commands\n")
        (self.folder / "bin/systemctl").chmod(0o755)

    def run_unit(self):
        """Runs the command of the unit as systemd would, on files of the test. Returns what systemctl was told."""
        text = (UNITS / "handcast-reboot@.service").read_text()
        line = re.search(r"^ExecStart=(.*)$", text, re.M)[1].replace("$$", "$").replace("%i", "show")
        words = shlex.split(line)
        self.assertEqual(words[-2:], ["/var/lib/handcast/show/watch/gives-up", "/var/lib/handcast-reboot/last"])
        self.request.touch()
        path = f"{self.folder}/bin:{os.environ['PATH']}"
        subprocess.run([*words[:-2], self.request, self.last], env={"PATH": path}, check=False, capture_output=True)
        commands = self.folder / "commands"
        told = commands.read_text().split("\n")[:-1] if commands.exists() else []
        commands.unlink(missing_ok=True)
        return told

    def age(self, hours):
        then = time.time() - hours * 3600
        os.utime(self.last, (then, then))

    def test_reboots_once_a_day(self):
        self.assertEqual(self.run_unit(), ["reboot"])
        self.assertEqual(self.run_unit(), [])
        self.age(23)
        self.assertEqual(self.run_unit(), [])
        self.age(25)
        self.assertEqual(self.run_unit(), ["reboot"])
        self.assertEqual(self.run_unit(), [])

    def test_the_request_is_taken_in_any_case(self):
        for _ in range(2):
            self.run_unit()
            self.assertFalse(self.request.exists())

    def test_a_clock_that_is_wrong_at_boot_makes_no_loop(self):
        self.run_unit()
        self.age(-50 * 365 * 24)
        self.assertEqual(self.run_unit(), [])

    def test_without_a_place_for_the_time_there_is_no_reboot(self):
        self.last.parent.rmdir()
        self.assertEqual(self.run_unit(), [])

    def test_the_path_unit_waits_for_the_file_of_the_night_watch(self):
        text = (UNITS / "handcast-reboot@.path").read_text()
        self.assertIn("\nPathExists=/var/lib/handcast/%i/watch/gives-up\n", text)


if __name__ == "__main__":
    unittest.main()

# SPDX-License-Identifier: Apache-2.0
"""What the tests of the pages share: their modules, a scratch folder, and their programs."""
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

REPOSITORY = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(REPOSITORY / "scripts"))

PATIENCE_S = 120  # ends what hangs
# What a page must not have that needs no network: addresses of others, and scripts. An xmlns in an embedded picture is none.
OUTSIDE = re.compile(r"<script|<link|@import|url\(|(src|href|srcset)=[\"'](?!data:|#)", re.IGNORECASE)


def program(verb):
    """The program of a verb."""
    return pathlib.Path(os.environ.get("HANDCAST_BIN", REPOSITORY / "build/bin")) / f"handcast-{verb}"


class Test(unittest.TestCase):
    """A test with an empty folder."""

    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)

    def run_program(self, verb, *words):
        """Runs the program of a verb: its exit code, its output and its errors."""
        done = subprocess.run([program(verb), *map(str, words)], capture_output=True, text=True, timeout=PATIENCE_S, check=False)
        return done.returncode, done.stdout, done.stderr

    def assert_needs_no_network(self, page):
        """A page has all that it shows."""
        self.assertIsNone(OUTSIDE.search(page))

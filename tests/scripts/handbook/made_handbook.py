# SPDX-License-Identifier: Apache-2.0
"""What the tests of the handbook share: its modules, and a handbook that was made of this checkout."""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

REPOSITORY = pathlib.Path(__file__).resolve().parents[3]
BIN = pathlib.Path(os.environ.get("HANDCAST_BIN", REPOSITORY / "build/bin"))
sys.path.insert(0, str(REPOSITORY / "scripts"))

PATIENCE_S = 580  # ends what hangs


def make(folder, *options):
    """Makes a handbook; its exit code and what it says."""
    done = subprocess.run([REPOSITORY / "scripts/handbook/make.py", folder, "--bin", BIN, *options], capture_output=True, text=True,
                          timeout=PATIENCE_S, check=False)
    return done.returncode, done.stderr


class Made(unittest.TestCase):
    """Tests of one handbook, which they may change in a copy."""

    @classmethod
    def setUpClass(cls):
        scratch = tempfile.TemporaryDirectory()
        cls.addClassCleanup(scratch.cleanup)
        cls.folder = pathlib.Path(scratch.name) / "handbook"
        code, said = make(cls.folder)
        assert code == 0, said

    def copy(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        return pathlib.Path(shutil.copytree(self.folder, scratch.name, dirs_exist_ok=True))

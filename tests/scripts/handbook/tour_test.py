# SPDX-License-Identifier: Apache-2.0
"""The pictures of the tour are made anew by a rig, and show light."""
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

from made_handbook import BIN, PATIENCE_S, REPOSITORY, make

import cv2

# Where light is in a picture, and the least share of orange pixels there, which lava, henna and a finger of the default picture have.
ALL = slice(None)
LIGHT = {"config/assets/preview.png": ((ALL, ALL), 0.005), "config/assets/desk.png": ((slice(140, 370), slice(1085, 1390)), 0.02),
         "config/assets/readme_looks.png": ((ALL, ALL), 0.02), "docs/tour_light.png": ((ALL, ALL), 0.005)}
PAPER = "docs/tour_calibration.png"


def share_of(pixels):
    return float(pixels.mean())


def orange(picture):
    blue, _, red = (channel.astype(int) for channel in cv2.split(picture))
    return share_of(red - blue > 100)


@unittest.skipUnless(shutil.which("chromium"), "chromium is not installed")
class TheTour(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        scratch = tempfile.TemporaryDirectory()
        cls.addClassCleanup(scratch.cleanup)
        cls.pictures, cls.handbook = pathlib.Path(scratch.name) / "pictures", pathlib.Path(scratch.name) / "handbook"
        subprocess.run([REPOSITORY / "scripts/handbook/tour.py", cls.pictures], check=True, timeout=PATIENCE_S,
                       env={**os.environ, "HANDCAST_BIN": str(BIN)})

    def test_has_no_other_pictures(self):
        made = {file.relative_to(self.pictures).as_posix() for file in self.pictures.rglob("*.png")}
        self.assertEqual(made, {*LIGHT, PAPER})

    def test_has_pictures_with_light_on_a_dark_ground(self):
        for name, (place, least) in LIGHT.items():
            picture = cv2.imread(str(self.pictures / name))
            with self.subTest(name):
                self.assertGreater(picture.shape[1], 1000)
                self.assertGreater(orange(picture[place]), least)
                self.assertGreater(share_of(picture.max(axis=2) < 60), 0.3)

    def test_has_a_report_with_ink_on_a_light_ground(self):
        picture = cv2.imread(str(self.pictures / PAPER))
        self.assertGreater(share_of(picture.min(axis=2) > 200), 0.5)
        self.assertGreater(share_of(picture.max(axis=2) < 200), 0.01)

    def test_is_shown_with_these_pictures(self):
        self.assertEqual(make(self.handbook, "--pictures", self.pictures), (0, ""))
        page = (self.handbook / "docs/tour.html").read_text(encoding="utf-8")
        for name in (*LIGHT, PAPER):
            with self.subTest(name):
                self.assertIn(f'/{pathlib.Path(name).name}"' if "assets" in name else f'"{pathlib.Path(name).name}"', page)
                self.assertEqual((self.handbook / name).read_bytes(), (self.pictures / name).read_bytes())


if __name__ == "__main__":
    unittest.main()

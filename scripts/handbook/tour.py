#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Makes the pictures of docs/tour.md anew, by the commands that it tells: about a minute and a half.

usage: tour.py OUT

OUT gets them by their paths in the repository. HANDCAST_BIN: the folder of the programs (default: build/bin).
"""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import cv2

from browser import Tab, open_browser
from running_rig import HANDCAST, ROOT, Rig

PATIENCE_S = 300  # ends what hangs
TWIN = ROOT / "config/rigs/twin.toml"
# As slow as a computer with two cores needs it, and quiet.
RIG = ("camera.rate_hz=60", "projector.rate_hz=60", "observer.enabled=false", "desk.page.listen=127.0.0.1:0")
# On a phone, the page of the desk has tabs.
TO_PICTURE = """getComputedStyle(document.getElementById('tabs')).display === 'none' ||
    document.querySelector('#tabs a[href="#picture"]').click()"""
# Whether the live picture of the desk shows a hand.
LIVE = """(() => { const c = document.getElementById('{}'), d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data;
          return c.width > 100 && d.some((value, i) => i % 4 === 0 && value > 100); })()"""


def handcast(*words, **options):
    done = subprocess.run([HANDCAST, *map(str, words)], capture_output=True, text=True, timeout=PATIENCE_S, check=False, **options)
    if done.returncode:
        sys.exit(f"tour.py: handcast {words[0]}: {done.stderr}")


def beside(pictures, gap_px=0):
    """Pictures side by side, as high as the highest."""
    height = max(picture.shape[0] for picture in pictures)
    padded = [cv2.copyMakeBorder(picture, 0, height - picture.shape[0], gap_px if number else 0, 0, cv2.BORDER_CONSTANT)
              for number, picture in enumerate(pictures)]
    return cv2.hconcat(padded)


def looks(file, scratch):
    handcast("gallery", "xray", "water", "lava", "henna", "--frames", 8, "--sheet", file, "--out", scratch / "gallery")


def light(file, scratch):
    """Three moments, cut out around the hand."""
    frames = scratch / "light"
    handcast("simulate", TWIN, "--motion", "builtin:shake", "--seconds", "0.5", "--quiet", "--frames", frames)
    moments = [cv2.imread(str(frame))[200:700, 300:800] for frame in sorted(frames.glob("*.png"))[2:11:3]]
    cv2.imwrite(str(file), beside(moments))


def calibration(file, scratch, browser):
    shutil.copy(TWIN, scratch / "my_twin.toml")
    handcast("calibrate", "my_twin.toml", "lens", "--yes", *(word for setting in RIG for word in ("--set", setting)), cwd=scratch)
    tab = Tab(browser, (scratch / "my_twin.calibration/report.html").as_uri(), 1100, 950)
    tab.js("document.documentElement.style.overflow = 'hidden'")
    tab.picture(file)


def desk(file, address, scratch, browser):
    """The page on a desktop, and its live picture on a phone."""
    views = []
    for width, height in ((1440, 900), (390, 900)):
        tab = Tab(browser, address, width, height)
        tab.wait("document.getElementById('link-text').textContent.startsWith('connected')", "the desk")
        tab.js(TO_PICTURE)
        for canvas in ("camera", "light"):
            tab.wait(LIVE.replace("{}", canvas), f"the live picture: {canvas}")
        tab.picture(scratch / "view.png")
        views.append(cv2.imread(str(scratch / "view.png")))
        tab.close()
    cv2.imwrite(str(file), beside(views, gap_px=24))


def running(pictures, scratch, browser):
    """Of a rig that is up."""
    with open(scratch / "rig.log", "w", encoding="utf-8") as log:
        rig = Rig(TWIN, RIG, log)
        try:
            rig.wait_until_ready()
            rig.run("content", "lava")
            rig.run("preview", "--shot", str(pictures / "preview.png"), "--after", "3")
            desk(pictures / "desk.png", rig.run("desk")[1].split()[0], scratch, browser)
        finally:
            rig.stop()


def main(out):
    os.environ["HANDCAST_SCOPE"] = f"tour-{os.getpid()}"  # no other rig is in the way
    assets, docs = out / "config/assets", out / "docs"
    for folder in (assets, docs):
        folder.mkdir(parents=True, exist_ok=True)
    chromium = shutil.which("chromium") or sys.exit("tour.py: chromium is missing; `scripts/setup chromium` installs it")
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder, open_browser(chromium) as browser:
        scratch = pathlib.Path(folder)
        looks(assets / "readme_looks.png", scratch)
        light(docs / "tour_light.png", scratch)
        running(assets, scratch, browser)
        calibration(docs / "tour_calibration.png", scratch, browser)


if __name__ == "__main__":
    if len(sys.argv) != 2 or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    main(pathlib.Path(sys.argv[1]).resolve())

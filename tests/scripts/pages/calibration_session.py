# SPDX-License-Identifier: Apache-2.0
"""The folder of a calibration, as `handcast calibrate` leaves it."""
import json
import math
import random


def picture(kind, caption, **numbers):
    """A picture of a step."""
    return {"kind": kind, "caption": caption, "numbers": numbers}


def dots(width_px, height_px, count):
    """Dots in an image."""
    chance = random.Random(1)
    return picture("dots", "Where the board was seen.", size_px=[width_px, height_px],
                   right_px=[chance.uniform(0, width_px) for _ in range(count)], down_px=[chance.uniform(0, height_px) for _ in range(count)])


def bars(*left_out):
    """Errors of 15 images, of which some were left out."""
    return picture("bars", "How far the corners are off.", rms_px=[0.05 + 0.02 * (i * 7 % 5) + (0.2 if i in left_out else 0) for i in range(15)],
                   is_left_out=[int(i in left_out) for i in range(15)])


def depths():
    """Errors of three depths."""
    columns, rows = 24, 18
    return picture("depths", "What one homography would miss.", grid=[columns, rows], depth_m=[0.6, 0.73, 0.85],
                   error_px=[abs(shift) * (1 + 0.01 * column + 0.005 * row)
                             for shift in (18, 0, -11) for row in range(rows) for column in range(columns)])


def gamma():
    """Grey steps of a projector."""
    levels = [i / 64 for i in range(65)]
    steps = [i / 9 for i in range(1, 9)] * 3
    return picture("gamma", "The light by the level.", level=steps, share=[level**1.8 + 0.01 * math.sin(40 * i) for i, level in enumerate(steps)],
                   curve_level=levels, fitted=[level**1.8 for level in levels], set=[level**2.2 for level in levels])


def histograms():
    """Grey values of a hand before a background."""
    def around(middle, width):
        return [round(1e4 * math.exp(-((grey - middle) / width)**2)) for grey in range(256)]
    return picture("histograms", "Grey values.", background=around(13, 5), hand=around(92, 22), tips=around(66, 12), threshold=[35])


def places():
    """What a fit does not know in the middle and at the corners."""
    return picture("places", "What the fit does not know.", right_mm=[-0.2, -120, 120], down_mm=[0, -90, 90], far_m=[0.73, 0.58, 0.88],
                   light_mm=[0.62, 1.3, 1.12], space_mm=[1.5, 2.4, 2.26])


STEPS = {
    "lens": ("15 images, 0.07 px held out, focal length 1161.9 px +- 0.32 %", ["image 15 was left out. Its error is large"],
             "Held out: good is at most 0.6 px. +-: with 95 % probability", lambda: [dots(720, 540, 900), bars(14)]),
    "screen": ("5 places of the board, 0.21 px held out, the projector is 50 mm from the camera, +- 1",
               ["projector.gamma was 2.2", "was the board still?", "look. At it"], "held out: good is at most 1 px",
               lambda: [dots(720, 540, 1500), depths(), gamma()]),
    "tracker": ("1.1 px held out, 97 % of the points fit", [], "Held out: good is at most 3 px", lambda: [dots(720, 540, 1200), places()]),
    "light": ("grey values of 200 images: hand 92, finger tips 66, background 13", ["exposure and infrared light are good"], "Grey values",
              lambda: [histograms()]),
}


def write_session(where, measured, steps=tuple(STEPS), **more):
    """Writes a session in which some steps are measured."""
    reported = [{"step": name, "made": f"2026-01-01: {STEPS[name][0]}" if name in measured and name != "light" else "", "is_done": name in measured}
                for name in steps]
    report = {"rig": "show", "rig_file": "my_rig.toml", "board": "", "folder": "", "steps": reported} | more
    (where / "report.json").write_text(json.dumps(report), encoding="utf-8")
    for name in measured:
        made, findings, meaning, pictures = STEPS[name]
        outcome = {"made": made, "findings": findings, "meaning": meaning, "pictures": pictures()}
        (where / f"{name}.json").write_text(json.dumps(outcome), encoding="utf-8")

# SPDX-License-Identifier: Apache-2.0
"""The errors of landmark models, from the lines of handcast-evaluate-landmarks.

handcast-evaluate-landmarks --models MODELS --motion A --motion B --picture 1_camera.png | python3 evaluate.py [--tips TIPS.json]
"""
import argparse
import json
import sys

import numpy as np

FINGERS = [[4 * f + k for k in range(1, 5)] for f in range(5)]
TIPS = [4, 8, 12, 16, 20]
LEVELS = (0.5, 0.68, 0.9, 0.95)
TITLES = {
    "tracker": "tracker's joints",
    "mediapipe": "MediaPipe lite",
    "mediapipe_corrected": "MediaPipe lite, offsets removed",
    "handcast": "handcast",
    "handcast_corrected": "handcast, offsets removed",
    "handcast_one_pass": "handcast, one pass",
    "handcast_alone": "handcast without the tracker",
    "handcast_wrong_tracker": "handcast, tracker in another pose",
    "handcast_wrong_region": "handcast without the tracker, region of that pose",
}


def hand_frame(points):
    """Rotation to the hand's own axes, and the palm's length."""
    up = points[9] - points[0]
    length = np.hypot(*up)
    x, y = up / length
    return np.array([[-y, x], [-x, -y]]), length


def without_offsets(points, truth, sources):
    """Subtracts each landmark's median offset in the hand's frame: that of one half of every recording from the other half."""
    frames = [hand_frame(t) for t in truth]
    offsets = np.array([(p - t) @ r.T / n for p, t, (r, n) in zip(points, truth, frames)])
    half = np.zeros(len(points), bool)
    for source in np.unique(sources):
        (rows,) = np.where(sources == source)
        half[rows[len(rows) // 2 :]] = True
    corrected = points.copy()
    for part in (False, True):
        median = np.median(offsets[half == part], axis=0)
        for i in np.where(half != part)[0]:
            rotation, length = frames[i]
            corrected[i] -= median @ rotation * length
    return corrected


def errors_of(points, truth):
    return np.linalg.norm(points - truth, axis=2)


def finger_errors(errors):
    """Mean of the three outer joints: (n,5)."""
    return np.stack([errors[:, finger[1:]].mean(1) for finger in FINGERS], 1)


class Renders:
    def __init__(self, lines):
        self.sources = np.array([line["source"] for line in lines])
        self.truth = np.array([line["truth"] for line in lines])
        self.folded = np.array([line["folded"] for line in lines])
        self.points = {"tracker": np.array([line["tracker"] for line in lines])}
        self.sigma, self.presence = {}, {}
        for name in lines[0]["seen"]:
            self.points[name] = np.array([line["seen"][name]["points"] for line in lines])
            self.sigma[name] = np.array([line["seen"][name]["sigma"] for line in lines])
            self.presence[name] = np.array([line["seen"][name]["presence"] for line in lines])
        for name in ("mediapipe", "handcast"):
            if name in self.points:
                self.points[name + "_corrected"] = without_offsets(self.points[name], self.truth, self.sources)

    def table(self):
        boxes = np.ptp(self.truth, axis=1).max(1)
        print(f"{len(self.truth)} renders of {', '.join(np.unique(self.sources))}; hand box {np.median(boxes):.0f} px (median)\n")
        print("| model | mean | median | p95 | open | folded | frames > 25 px |\n|---|---|---|---|---|---|---|")
        for name in TITLES:
            if name in self.points:
                self.row(name)

    def row(self, name):
        errors = errors_of(self.points[name], self.truth)
        fingers = finger_errors(errors)
        wild = 100 * (errors.mean(1) > 25).mean()
        print(
            f"| {TITLES[name]} | {errors.mean():.2f} | {np.median(errors):.2f} | {np.percentile(errors, 95):.1f} "
            f"| {fingers[~self.folded].mean():.1f} | {fingers[self.folded].mean():.1f} | {wild:.1f} % |"
        )

    def by_motion(self):
        names = [name for name in ("mediapipe", "handcast", "handcast_alone") if name in self.points]
        print("\nBy motion: mean / median / p95\n\n| motion | fingers folded | " + " | ".join(TITLES[name] for name in names) + " |")
        print("|---" * (len(names) + 2) + "|")
        for source in np.unique(self.sources):
            rows = self.sources == source
            errors = [errors_of(self.points[name][rows], self.truth[rows]) for name in names]
            cells = [f"{e.mean():.1f} / {np.median(e):.1f} / {np.percentile(e, 95):.0f}" for e in errors]
            print(f"| {source} | {100 * self.folded[rows].mean():.0f} % | " + " | ".join(cells) + " |")

    def calibration(self, name="handcast"):
        """A Laplace distribution of scale b has the fraction 1 - exp(-t / b) within t; sigma = sqrt(2) b."""
        off = np.abs(self.points[name] - self.truth)
        scale = self.sigma[name][:, :, None] / np.sqrt(2)
        print(f"\nCoverage of {TITLES[name]}: fraction of the coordinates within the interval that should hold it")
        for level in LEVELS:
            inside = off < -np.log(1 - level) * scale
            print(f"  {100 * level:.0f} %: {100 * inside.mean():.1f} %")
        order = np.argsort(self.sigma[name].ravel())
        sigma, rms = self.sigma[name].ravel()[order], np.sqrt((off**2).mean(2)).ravel()[order]
        parts = np.array_split(np.arange(len(order)), 5)
        print("  sigma px -> error px per axis (RMS, by fifths): " + ", ".join(f"{sigma[p].mean():.1f} -> {np.sqrt((rms[p] ** 2).mean()):.1f}" for p in parts))


def pictures(lines, tips):
    print("\nReal pictures: distance of finger tips from where a person marked them, px")
    for name in TITLES:
        off = {}
        for line in lines:
            points = line["tracker"] if name == "tracker" else line["seen"].get(name, {}).get("points")
            if points is None:
                continue
            for tip, place in tips.get(line["source"], {}).items():
                off.setdefault(line["source"], []).append(np.hypot(*(np.array(points[int(tip)]) - place)))
        if off:
            every = np.concatenate(list(off.values()))
            per_picture = ", ".join(f"{k}: {np.mean(v):.1f}" for k, v in off.items())
            print(f"  {TITLES[name]}: mean {every.mean():.1f}, median {np.median(every):.1f}, worst {every.max():.1f} ({per_picture})")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--tips", help="JSON: {picture: {landmark: [x, y]}}, marked by a person")
    args = parser.parse_args()
    lines = [json.loads(line) for line in sys.stdin]
    rendered = [line for line in lines if "truth" in line]
    for builtin in (False, True):
        part = [line for line in rendered if line["source"].startswith("builtin:") == builtin]
        if part:
            renders = Renders(part)
            renders.table()
            renders.by_motion()
            renders.calibration()
            renders.calibration("handcast_alone")
            print()
    real = [line for line in lines if "truth" not in line]
    if real and args.tips:
        with open(args.tips, encoding="utf-8") as file:
            pictures(real, json.load(file))


if __name__ == "__main__":
    main()

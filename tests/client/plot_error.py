#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Plots the error of the light while a rig runs: what the observer has scored since it was looked at the last time.

usage: plot_error.py FOLDER [PICTURE SECONDS]
    handcast up RIG.toml --out FOLDER     # with the twin's camera

In a window; with PICTURE, into a file after so many seconds.
"""
import json
import pathlib
import sys
import time

import matplotlib

folder, *rest = sys.argv[1:]
if rest:
    matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

seconds, errors_mm = [], []
before, began = (0, 0.0), time.monotonic()
figure, axes = plt.subplots()
while not rest or time.monotonic() - began < float(rest[1]):
    try:
        scores = json.loads((pathlib.Path(folder) / "observer.json").read_text())
        frames, mean_mm = scores["frames"], scores["interior_mm"]["mean"]
    except (OSError, KeyError):
        frames, mean_mm = 0, None  # nothing was scored yet
    if mean_mm is not None and frames > before[0]:
        seconds.append(time.monotonic() - began)
        errors_mm.append((frames * mean_mm - before[0] * before[1]) / (frames - before[0]))
        before = frames, mean_mm
        axes.clear()
        axes.set(xlabel="s", ylabel="error of the light, mm", ylim=(0, max(15, *errors_mm)))
        axes.plot(seconds, errors_mm)
    if rest:
        time.sleep(0.5)
    else:
        plt.pause(0.5)
figure.savefig(rest[0])
print(f"{len(errors_mm)} points: {rest[0]}")

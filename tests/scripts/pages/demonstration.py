# SPDX-License-Identifier: Apache-2.0
"""The files of a demonstration, as simulate, observer and supervisor write them."""
import json
import math

import cv2
import numpy


def spread(value):
    """Mean and percentiles of an error."""
    return {"mean": value, "p95": 2.2 * value, "p99": 3 * value}


def metrics_of(rig, error_mm):
    """Metrics in the format of the simulator. `error_mm` is the mean error; most others follow from it."""
    bins = {name: {"frames": 100, "interior_mm": spread((0.5 + 0.4 * i) * error_mm), "coverage": 0.99}
            for i, name in enumerate(("0-0.1", "0.1-0.3", "0.3-0.6", "0.6-1.0"))}
    bins[">1.0"] = {"frames": 0, "interior_mm": {"mean": None, "p95": None}, "coverage": None}
    stages = {name: {"p50": 20 + 35 * i, "p99": 32 + 56 * i} for i, name in enumerate(("predict", "skin", "correct", "mask", "draw", "fill"))}
    return {"frames": 590, "interior_mm": spread(error_mm), "interior_px": spread(2.4 * error_mm), "coverage": 0.9912,
            "spill": 0.004 * error_mm, "iou": 0.985, "seam_px": 12.5, "jitter_px": 0.08, "foldovers": 0, "rig": rig,
            "motion": "builtin:open_close", "seconds": 2, "seed": 1, "equivalent_latency_ms": 4 * error_mm, "bins": bins,
            "frame_us": {"p50": 812.0, "p99": 1240.0}, "stage_us": stages | {"frame": {"p50": 812.0, "p99": 1240.0}}}


def live_run():
    """The supervisor's record of a live run."""
    return {"rig": "twin", "seconds": 20.02,
            "services": {name: {"restarts": 0, "backend": "twin"} for name in ("camera", "pose", "landmarks", "projector")},
            "rates": {"camera": {"wanted_hz": 525.0, "held_hz": 498.21}, "landmarks": {"wanted_hz": None, "held_hz": 61.4},
                      "projector": {"wanted_hz": 946.0, "held_hz": 903.5}},
            "slow_frames": {"projector": {"count": 100, "least_us": 1912.0, "preempted": 61, "interrupted": 20, "page_faults": 0, "own": 19}},
            "stage_us": {"capture": {"p50": 1240.0, "p99": 2600.0}, "detect": {"p50": 15010.0, "p99": 19800.0},
                         "present": {"p50": 3.0, "p99": 410.0}}}


def write_json(file, value):
    """Writes a JSON file."""
    file.write_text(json.dumps(value), encoding="utf-8")


def write_frames(folder, count, off_px):
    """Pictures of a disk that moves to and fro, with light that is displaced by `off_px`."""
    folder.mkdir(parents=True)
    for i in range(count):
        picture = numpy.full((768, 1024, 3), 20, numpy.uint8)
        x = 512 + round(120 * math.sin(0.2 * i))
        cv2.circle(picture, (x, 400), 90, (60, 70, 95), cv2.FILLED)
        cv2.circle(picture, (x + off_px, 400), 70, (90, 200, 120), cv2.FILLED)
        cv2.imwrite(str(folder / f"{i:06}.png"), picture)


def write_demonstration(folder, pictures):
    """Writes all files of a demonstration to a folder."""
    for name, error_mm, off_px in (("baseline", 7.6, 30), ("paper", 1.83, 12), ("twin", 1.21, 2)):
        write_json(folder / f"{name}.json", metrics_of(name, error_mm))
        write_frames(folder / "frames" / name, pictures, off_px)
    write_json(folder / "live.json", live_run())
    write_json(folder / "observer.json", metrics_of("twin", 1.3))

#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""A tracker in Python for bench_external: sends a hand 100 times a second, stamped when it is sent.

usage: external_tracker.py SECONDS"""
import sys
import time

import numpy

import handcast


def main():
    places_m = numpy.zeros((26, 3))
    for finger in range(5):
        for joint in range(5):
            places_m[1 + finger * 5 + joint] = (0.02 * finger - 0.04, 0.02 * joint, 0.3)
    joints = handcast.joints_of_points(places_m + [0, 0.01, 0], "left")
    rig = handcast.Rig("twin")
    end = time.monotonic() + float(sys.argv[1])
    number = 0
    while time.monotonic() < end:
        time.sleep(0.01)
        number += 1
        joints[:, 0] += 1e-4 if number % 2 else -1e-4
        rig.pose.publish({"left": joints}, handcast.now_ns())


if __name__ == "__main__":
    main()

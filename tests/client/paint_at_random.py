#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Paints on the left hand of a rig: a blot of a random colour at a random place for each sample of the tracker.

usage: PYTHONPATH=PREFIX/share/handcast/python paint_at_random.py [PICTURES]
    handcast content program: --hand left
"""
import itertools
import sys

import handcast
import numpy

dice = numpy.random.default_rng()
canvas = numpy.zeros((200, 320, 4), numpy.uint8)
y, x = numpy.mgrid[:200, :320]
try:
    with handcast.Content("left", 320, 200) as content:
        for _ in range(int(sys.argv[1])) if sys.argv[1:] else itertools.count():
            content.wait(1)
            blot = (x - dice.integers(320)) ** 2 + (y - dice.integers(200)) ** 2 < dice.integers(30) ** 2
            canvas[blot] = [*dice.integers(256, size=3), 255]
            content.begin()[:] = canvas
            content.publish()
except handcast.HandcastError as error:
    sys.exit(f"paint_at_random: {error}")

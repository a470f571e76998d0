#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Prints the hands of a rig's tracker, one line of JSON for each sample, for other programs.

usage: PYTHONPATH=PREFIX/share/handcast/python hands_to_json.py SAMPLES
"""
import json
import sys

import handcast

for _, hands in zip(range(int(sys.argv[1])), handcast.Rig().hands):
    there = {hand: hands.places_m(hand).tolist() for hand in handcast.HANDS if hands.joints(hand) is not None}
    print(json.dumps({"time_ns": hands.time_ns, **there}), flush=True)

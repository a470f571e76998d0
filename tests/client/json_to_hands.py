#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""The tracker of a rig: sends the hands that another program prints, one line of JSON for each sample.

usage: my_tracker | PYTHONPATH=PREFIX/share/handcast/python json_to_hands.py

A line has the places of 21 landmarks or 26 joints of each hand that is seen, m in tracker space, and the time:
    {"time_ns": 5123456789, "left": [[0.01, 0.2, 0.05], ...]}
Without a time it is now. The rig needs pose.backend = "external".
"""
import json
import sys

import handcast

try:
    rig = handcast.Rig()
    for line in sys.stdin:
        sample = json.loads(line)
        rig.pose.publish({hand: handcast.joints_of_points(sample[hand], hand) for hand in handcast.HANDS if hand in sample},
                         sample.get("time_ns") or handcast.now_ns())
except handcast.HandcastError as error:
    sys.exit(f"json_to_hands: {error}")

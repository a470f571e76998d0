#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Sends the finger tips of a rig as OSC, for TouchDesigner, Max, SuperCollider: /hand/left/thumb x y z, m in tracker space.

usage: PYTHONPATH=PREFIX/share/handcast/python hands_to_osc.py HOST PORT
"""
import socket
import struct
import sys

import handcast

TIPS = {"thumb": 5, "index": 10, "middle": 15, "ring": 20, "little": 25}


def message(address, *numbers):
    """An OSC message: texts end with 1 to 4 zeros, so that all parts have a multiple of 4 bytes."""
    texts = (text.encode() + b"\0" * (4 - len(text) % 4) for text in (address, "," + "f" * len(numbers)))
    return b"".join(texts) + struct.pack(f">{len(numbers)}f", *numbers)


out = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
try:
    for sample in handcast.Rig().hands:
        for hand in handcast.HANDS:
            if (places_m := sample.places_m(hand)) is not None:
                for finger, joint in TIPS.items():
                    out.sendto(message(f"/hand/{hand}/{finger}", *places_m[joint]), (sys.argv[1], int(sys.argv[2])))
except handcast.HandcastError as error:
    sys.exit(f"hands_to_osc: {error}")

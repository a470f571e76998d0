#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Draws waves on the right hand of a rig that follow the height of its palm.

usage: PYTHONPATH=PREFIX/share/handcast/python draw_waves.py PICTURES
"""
import sys

import handcast

WIDTH, HEIGHT = 160, 100


def main():
    with handcast.Content("right", WIDTH, HEIGHT, straight=True, lasts_s=1) as content:
        for number in range(int(sys.argv[1])):
            content.wait(1)
            hands = content.hands()
            places_m = hands.places_m("right") if hands else None
            shift = int(1000 * places_m[0][1]) if places_m is not None else 0
            rows = bytearray()
            for y in range(HEIGHT):
                rows += bytes((255, 128, 0, 255) if (y + shift) // 10 % 2 else (0, 64, 255, 128)) * WIDTH
            pixels = content.begin()
            if handcast.numpy is None:
                pixels[:] = rows
            else:
                pixels[:] = handcast.numpy.frombuffer(rows, "u1").reshape(HEIGHT, WIDTH, 4)
            content.publish(hands.time_ns if hands else 0)
            print(f"picture {number}: {'there' if places_m is not None else 'no hand'}", flush=True)


if __name__ == "__main__":
    try:
        main()
    except handcast.HandcastError as error:
        sys.exit(f"draw_waves: {error}")

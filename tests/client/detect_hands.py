#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""The detector of a rig: a network in ONNX, run by OpenCV on the images of the rig's camera.

usage: PYTHONPATH=PREFIX/share/handcast/python detect_hands.py NETWORK.onnx IMAGES

It ends after so many images. The network is the one of handcast (share/handcast/landmarks/handcast.onnx); for another
one, change region(), which crops and mirrors, and look(), which makes the input and reads the output. The hand is the
left one and the brightest thing in the image; afterwards it is looked for where it was.
    handcast up RIG.toml --set landmarks.backend=external
"""
import sys

import cv2
import handcast
import numpy

SIDE = 96
SLOTS = (numpy.arange(12) + 0.5) / 12


class Detector:
    def __init__(self, network):
        self.network = cv2.dnn.readNet(network)
        self.points = None  # of the image before

    def region(self, image):
        """Crop to image, 2 x 3: around the points of the image before, upright, or around the brightest thing."""
        if self.points is None:
            _, bright = cv2.threshold(image, 0, 255, cv2.THRESH_OTSU)
            x, y, width, height = cv2.boundingRect(max(cv2.findContours(
                bright, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_SIMPLE)[0], key=cv2.contourArea))
            centre, size, angle = numpy.array([x + width / 2, y + min(width, height) / 2]), 1.2 * min(width, height), 0
        else:
            up = self.points[9] - self.points[0]
            angle = numpy.arctan2(up[0], -up[1])
            turn = numpy.array([[numpy.cos(angle), numpy.sin(angle)], [-numpy.sin(angle), numpy.cos(angle)]])
            upright = self.points @ turn.T
            low, high = upright.min(0), upright.max(0)
            centre, size = (low + high) / 2 @ turn, max(1.3 * (high - low).max(), 1.45 * numpy.linalg.norm(up))
        right = numpy.array([numpy.cos(angle), numpy.sin(angle)]) * size / SIDE
        down = numpy.array([-right[1], right[0]])
        right = -right  # left hands are mirrored
        return numpy.column_stack([right, down, centre - (right + down) * (SIDE - 1) / 2])

    def look(self, image, region):
        """The landmarks, px of the image, and how likely there is a hand."""
        crop = cv2.warpAffine(image, region, (SIDE, SIDE), flags=cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP)
        shown = numpy.minimum(crop / max(numpy.percentile(crop, 98), 12), 1.5) - 0.4
        self.network.setInput(shown.astype(numpy.float32)[None, None], "image")
        self.network.setInput(numpy.zeros((1, 21, 24, 24), numpy.float32), "tracker")
        maps = self.network.forward()[0]
        heat = numpy.exp(maps[:21] - maps[:21].max((1, 2), keepdims=True))
        heat /= heat.sum((1, 2), keepdims=True)
        places = numpy.stack([heat.sum(1) @ SLOTS, heat.sum(2) @ SLOTS], 1) * SIDE - 0.5
        return places @ region[:, :2].T + region[:, 2], 1 / (1 + numpy.exp(-maps[42].mean()))

    def detect(self, image):
        """The 21 landmarks, or None."""
        for _ in range(3 if self.points is None else 1):
            self.points, presence = self.look(image, self.region(image))
        if presence < 0.5:
            self.points = None
        return self.points


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    detector = Detector(sys.argv[1])
    rig = handcast.Rig()
    for number, frame in zip(range(int(sys.argv[2])), rig.camera):
        points = detector.detect(frame.pixels)
        rig.landmarks.publish({} if points is None else {"left": points}, frame.time_ns, frame.number)
        print(f"image {number}: {'no hand' if points is None else 'hand'}", flush=True)


if __name__ == "__main__":
    try:
        main()
    except handcast.HandcastError as error:
        sys.exit(f"detect_hands: {error}")

#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Reads what `handcast record` writes (docs/recordings.md), with numpy alone. usage: scripts/read_recording.py FOLDER"""
import json
import pathlib
import sys
import zlib

import numpy as np


def dtype(fields):
    return np.dtype([(name, dtype(kind) if isinstance(kind, list) else kind, *map(tuple, shape)) for name, kind, *shape in fields])


class Stream:
    """The messages of one stream; stream.index has a row for each, with its times."""

    def __init__(self, folder, name):
        folder = pathlib.Path(folder)
        about = json.loads((folder / "recording.json").read_text())
        if about.get("version") != 1:
            raise ValueError(f"{folder}: version {about.get('version')} of the format is not known")
        self.message_type, self.channels = dtype(about["streams"][name]["message"]), about["streams"][name]["channels"]
        rows = (folder / f"{name}.index").read_bytes()
        row = dtype(about["index"])
        self.index = np.frombuffer(rows[: len(rows) // row.itemsize * row.itemsize], row)
        self.data = (folder / f"{name}.data").open("rb")
        there = (folder / f"{name}.data").stat().st_size
        sizes = self.index["head_bytes"].astype(np.uint64) + self.index["image_bytes"]
        cut = (self.index["offset"] > there) | (sizes > there - np.minimum(self.index["offset"], there))
        self.index = self.index[~cut]

    def stored(self, number):
        """The head and the packed image of a message."""
        row = self.index[number]
        self.data.seek(int(row["offset"]))
        stored = self.data.read(int(row["head_bytes"]) + int(row["image_bytes"]))
        if zlib.crc32(stored) != row["crc"]:
            raise ValueError(f"message {number} is damaged")
        return stored[: row["head_bytes"]], stored[row["head_bytes"] :]

    def message(self, number):
        """The fields of a message: stream.message(7)["hands"][0]["joints"]["position_m"]."""
        head, _ = self.stored(number)
        return np.frombuffer(head.ljust(self.message_type.itemsize, b"\0"), self.message_type)[0]

    def image(self, number):
        """Its image: (rows, columns) of grey values, or (rows, columns, 4) of RGBA."""
        row = self.index[number]
        steps = np.frombuffer(zlib.decompress(self.stored(number)[1]), np.uint8)
        rows = np.cumsum(steps.reshape(-1, row["width_px"]), axis=0, dtype=np.uint8)
        planes = rows.reshape(self.channels, row["height_px"], row["width_px"])
        if self.channels == 1:
            return planes[0]
        red, green, blue, alpha = planes
        return np.stack([red + green, green, blue + green, alpha], axis=-1)


if __name__ == "__main__":
    if len(sys.argv) != 2 or not (pathlib.Path(sys.argv[1]) / "recording.json").exists():
        sys.exit(__doc__)
    for index in sorted(pathlib.Path(sys.argv[1]).glob("*.index")):
        stream = Stream(sys.argv[1], index.stem)
        span_s = np.ptp(stream.index["published_ns"]) * 1e-9 if len(stream.index) else 0
        print(f"{index.stem}: {len(stream.index)} messages in {span_s:.2f} s, {stream.index['lost'].sum()} lost")

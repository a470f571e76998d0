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
        self.message_type, self.channels = dtype(about["streams"][name]["message"]), about["streams"][name]["channels"]
        rows = (folder / f"{name}.index").read_bytes()
        row = dtype(about["index"])
        self.index = np.frombuffer(rows[: len(rows) // row.itemsize * row.itemsize], row)
        self.data = (folder / f"{name}.data").open("rb")
        ends = self.index["offset"] + self.index["head_bytes"] + self.index["image_bytes"]
        self.index = self.index[: np.append(ends > (folder / f"{name}.data").stat().st_size, True).argmax()]

    def message(self, number):
        """The fields of a message: stream.message(7)["hands"][0]["joints"]["position_m"]."""
        row = self.index[number]
        self.data.seek(row["offset"])
        head = self.data.read(row["head_bytes"])
        return np.frombuffer(head.ljust(self.message_type.itemsize, b"\0"), self.message_type)[0]

    def image(self, number):
        """Its image: (rows, columns) of grey values, or (rows, columns, 4) of RGBA."""
        row = self.index[number]
        self.data.seek(row["offset"] + row["head_bytes"])
        steps = np.frombuffer(zlib.decompress(self.data.read(row["image_bytes"])), np.uint8)
        rows = np.cumsum(steps.reshape(-1, row["width_px"]), axis=0, dtype=np.uint8)
        planes = rows.reshape(self.channels, row["height_px"], row["width_px"])
        if self.channels == 1:
            return planes[0]
        red, green, blue, alpha = planes
        return np.stack([red + green, green, blue + green, alpha], axis=-1)


if __name__ == "__main__":
    for index in sorted(pathlib.Path(sys.argv[1]).glob("*.index")):
        stream = Stream(sys.argv[1], index.stem)
        span_s = np.ptp(stream.index["published_ns"]) * 1e-9 if len(stream.index) else 0
        print(f"{index.stem}: {len(stream.index)} messages in {span_s:.2f} s, {stream.index['lost'].sum()} lost")

# SPDX-License-Identifier: Apache-2.0
"""Training images from handcast-training-images, as batches of tensors."""
import subprocess
import threading
from queue import Queue

import numpy as np
import torch

from network import LANDMARKS, SIDE

UNIT, SHIFT = 170.0, 0.4  # Sample::kUnit in film.hpp, kShownShift in handcast_network.hpp
SAMPLE = np.dtype(
    [
        ("tracker", "<f4", (LANDMARKS, 2)),
        ("truth", "<f4", (LANDMARKS, 2)),
        ("image", "u1", (SIDE, SIDE)),
        ("visible", "u1", LANDMARKS),
        ("has_tracker", "u1"),
        ("has_hand", "u1"),
        ("reserved", "u1"),
    ]
)


class Batch:
    def __init__(self, samples):
        self.image = (torch.from_numpy(samples["image"].astype(np.float32)) / UNIT - SHIFT)[:, None]
        self.truth = torch.from_numpy(samples["truth"].copy())
        self.tracker = torch.from_numpy(samples["tracker"].copy())
        self.has_tracker = torch.from_numpy(samples["has_tracker"].astype(np.float32))
        self.has_hand = torch.from_numpy(samples["has_hand"].astype(np.float32))
        self.visible = torch.from_numpy(samples["visible"].astype(bool))


def batches(program, seed, first, size, people):
    """Yields batches from image number `first` on, without end; the program runs a few batches ahead."""
    command = [program, "--seed", str(seed), "--first", str(first), "--count", str(1 << 40), "--people", str(people)]
    child = subprocess.Popen(command, stdout=subprocess.PIPE)
    queue = Queue(8)

    def read():
        while True:
            data = child.stdout.read(SAMPLE.itemsize * size)
            queue.put(data)
            if len(data) < SAMPLE.itemsize * size:
                return

    threading.Thread(target=read, daemon=True).start()
    try:
        while True:
            data = queue.get()
            if len(data) < SAMPLE.itemsize * size:
                raise SystemExit(f"{program} has ended")
            yield Batch(np.frombuffer(data, SAMPLE))
    finally:
        child.kill()

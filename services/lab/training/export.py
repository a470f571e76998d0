# SPDX-License-Identifier: Apache-2.0
"""Writes a trained landmark network as an ONNX file of basic operators; normalisations are folded into the convolutions.

python3 export.py out/training/training.pt out/training/handcast.onnx
"""
import sys
from pathlib import Path

import torch

from network import LANDMARKS, MAP, SIDE, LandmarkNetwork


def export(network, file):
    network = network.to(memory_format=torch.contiguous_format).eval()
    example = (torch.zeros(1, 1, SIDE, SIDE), torch.zeros(1, LANDMARKS, MAP, MAP))
    torch.onnx.export(network, example, str(file), opset_version=11, input_names=["image", "tracker"], output_names=["maps"])


if __name__ == "__main__":
    trained = LandmarkNetwork()
    trained.load_state_dict(torch.load(sys.argv[1])["mean"])
    export(trained, Path(sys.argv[2]))

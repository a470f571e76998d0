# SPDX-License-Identifier: Apache-2.0
"""handcast's landmark network: convolutions from a grey crop and the tracker's maps to one heat map per landmark."""
import math

import torch
from torch import nn
from torch.nn import functional as F

SIDE = 96  # pixels of the crop
MAP = 24  # cells of a tracker map
CELLS = 12  # cells of a heat map
LANDMARKS = 21
WIDTHS = (16, 32, 64, 96)
CODE = 64  # numbers that encode the layout of the tracker's joints
MAP_SIGMA = 1.2  # of a tracker map's Gaussian, in its cells


def conv(inputs, outputs, stride=1):
    return nn.Sequential(nn.Conv2d(inputs, outputs, 3, stride, 1, bias=False), nn.BatchNorm2d(outputs))


class Block(nn.Module):
    """A residual block of two convolutions (He et al. 2016)."""

    def __init__(self, width):
        super().__init__()
        self.first, self.second = conv(width, width), conv(width, width)
        nn.init.zeros_(self.second[1].weight)

    def forward(self, x):
        return F.relu(x + self.second(F.relu(self.first(x))))


def ramps():
    """Weights that read a tracker map: the place of its Gaussian, x and y in -1..1, and the part of it in the map: (576,3)."""
    down, across = torch.meshgrid(*2 * [torch.linspace(-1, 1, MAP)], indexing="ij")
    read = torch.stack([across.flatten(), down.flatten(), torch.ones(MAP * MAP)], 1)
    return read / (2 * math.pi * MAP_SIGMA**2)


class Layout(nn.Module):
    """The layout of the tracker's joints, which shows where it defines wrist and knuckles: maps -> (n,width,1,1).

    Convolutions are local; this needs distances of half the crop to a few per cent."""

    def __init__(self, width):
        super().__init__()
        self.register_buffer("ramps", ramps())
        self.first, self.second = nn.Conv2d(3 * LANDMARKS, CODE, 1), nn.Conv2d(CODE, width, 1)
        nn.init.zeros_(self.second.weight)
        nn.init.zeros_(self.second.bias)

    @torch.autocast("cpu", enabled=False)
    def forward(self, maps):
        read = maps.reshape(-1, LANDMARKS, MAP * MAP) @ self.ramps
        return self.second(F.relu(self.first(read.reshape(-1, 3 * LANDMARKS, 1, 1))))


class LandmarkNetwork(nn.Module):
    """image (n,1,96,96), tracker maps (n,21,24,24; all 0 if there is no tracker) -> (n,43,12,12): 21 heat maps before the softmax,
    21 maps of log sigma (as a fraction of the crop), and one whose mean is the logit of presence."""

    def __init__(self, widths=WIDTHS):
        super().__init__()
        a, b, c, d = widths
        self.stem = conv(1, a, 2)
        self.down1, self.block1 = conv(a, b, 2), Block(b)
        self.tracker = nn.Conv2d(LANDMARKS, b, 3, 1, 1)
        self.down2, self.block2 = conv(b, c, 2), Block(c)
        self.down3, self.block3 = conv(c, d, 2), Block(d)
        self.layout = Layout(d)
        self.up, self.merged = nn.Conv2d(d, c, 1), Block(c)
        self.head = conv(c, c)
        self.out = nn.Conv2d(c, 2 * LANDMARKS + 1, 1)
        nn.init.normal_(self.tracker.weight, 0, 0.03)
        nn.init.zeros_(self.out.bias)
        with torch.no_grad():
            self.out.bias[LANDMARKS : 2 * LANDMARKS] = -3.5

    def forward(self, image, tracker):
        x = F.relu(self.down1(F.relu(self.stem(image))))
        x = self.block1(F.relu(x + self.tracker(tracker)))
        x = self.block2(F.relu(self.down2(x)))
        deep = self.block3(F.relu(self.down3(x) + self.layout(tracker)))
        x = self.merged(F.relu(x + F.interpolate(self.up(deep), scale_factor=2, mode="nearest")))
        return self.out(F.relu(self.head(x)))


def tracker_maps(places, present):
    """places (n,21,2) in 0..1 of the crop, present (n,) 0 or 1 -> (n,21,24,24)."""
    centres = (torch.arange(MAP) + 0.5) / MAP
    k = 0.5 * (MAP / MAP_SIGMA) ** 2
    across = torch.exp(-k * (centres - places[:, :, 0:1]) ** 2)
    down = torch.exp(-k * (centres - places[:, :, 1:2]) ** 2)
    return down[:, :, :, None] * across[:, :, None, :] * present[:, None, None, None]


def decode(out):
    """-> places (n,21,2) in 0..1, log sigma (n,21), hand logit (n,), heat (n,21,144)."""
    out = out.float().flatten(2)
    heat = out[:, :LANDMARKS].softmax(2)
    cells = torch.arange(CELLS * CELLS)
    x, y = (cells % CELLS + 0.5) / CELLS, (cells // CELLS + 0.5) / CELLS
    places = torch.stack([(heat * x).sum(2), (heat * y).sum(2)], 2)
    log_sigma = (heat * out[:, LANDMARKS : 2 * LANDMARKS]).sum(2)
    return places, log_sigma, out[:, 2 * LANDMARKS].mean(1), heat

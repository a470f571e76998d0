# SPDX-License-Identifier: Apache-2.0
"""Trains the landmark network on images from handcast-training-images, while they are made. After Ctrl-C, the same command continues.

python3 train.py --program build/bin/handcast-training-images --minutes 240 --folder out/training
"""
import argparse
import copy
import math
import time
from pathlib import Path

import torch
from torch.nn import functional as F

from export import export
from exported import start_from
from generated import batches
from network import CELLS, LandmarkNetwork, decode, tracker_maps

# Without the processor's help, bfloat16 takes 20 times as long as float32.
HAS_BFLOAT16 = "avx512_bf16" in Path("/proc/cpuinfo").read_text()
PIXELS = 96  # errors are reported in px of the crop
WARM_UP = 200  # steps
FIRST_LOOK = 512  # images that set the normalisations of a network that is trained further
DECAY = 0.998  # of the running mean of the weights, which is exported


def heat_targets(truth):
    """Gaussians of 0.75 cells around the truth, each with sum 1: (n,21,144)."""
    centres = (torch.arange(CELLS) + 0.5) / CELLS
    k = 0.5 * (CELLS / 0.75) ** 2
    across = torch.exp(-k * (centres - truth[:, :, 0:1]) ** 2)
    down = torch.exp(-k * (centres - truth[:, :, 1:2]) ** 2)
    target = (down[:, :, :, None] * across[:, :, None, :]).flatten(2)
    return target / (target.sum(2, keepdim=True) + 1e-6)


def losses(out, batch):
    """-> loss, mean error of landmarks in the crop (px). Landmarks outside the crop train only their sigma."""
    places, log_sigma, hand, heat = decode(out)
    here = batch.has_hand > 0
    inside = ((batch.truth > 0) & (batch.truth < 1)).all(2) & here[:, None]
    point = F.smooth_l1_loss(places, batch.truth, beta=0.01, reduction="none").mean(2)
    cross = -(heat_targets(batch.truth) * torch.log(heat + 1e-9)).sum(2)
    off = (places - batch.truth).abs().detach().sum(2)
    laplace = 2 * log_sigma + off * torch.exp(-log_sigma)
    presence = F.binary_cross_entropy_with_logits(hand, batch.has_hand)
    loss = 20 * point[inside].mean() + 0.05 * cross[inside].mean() + 0.02 * laplace[here].mean() + 0.05 * presence
    return loss, (places - batch.truth).norm(dim=2)[inside].mean().item() * PIXELS


def lay_out(tensor):
    return tensor.contiguous(memory_format=torch.channels_last)


class Training:
    def __init__(self, args):
        self.args, self.file = args, Path(args.folder) / "training.pt"
        self.network = LandmarkNetwork().to(memory_format=torch.channels_last)
        self.mean = copy.deepcopy(self.network)
        self.optimizer = torch.optim.AdamW(self.network.parameters(), lr=args.rate, weight_decay=1e-3, foreach=True)
        self.steps, self.images, self.seconds, self.error = 0, 0, 0.0, None
        if self.file.exists():
            self.restore(torch.load(self.file))
        elif args.start:
            self.start_from(args.start)

    def start_from(self, file):
        a = self.args
        batch = next(batches(a.program, a.seed + 1, 0, FIRST_LOOK, a.people))
        start_from(self.network, file, batch.image, tracker_maps(batch.tracker, batch.has_tracker))
        self.mean.load_state_dict(self.network.state_dict())
        print(f"starts with the weights of {file}", flush=True)

    def restore(self, state):
        for name in ("network", "mean", "optimizer"):
            getattr(self, name).load_state_dict(state[name])
        self.steps, self.images, self.seconds = state["steps"], state["images"], state["seconds"]
        print(f"continues after {self.images} images, {self.seconds / 60:.0f} minutes", flush=True)

    def save(self):
        state = {name: getattr(self, name).state_dict() for name in ("network", "mean", "optimizer")}
        state |= {"steps": self.steps, "images": self.images, "seconds": self.seconds}
        torch.save(state, self.file.with_suffix(".new"))
        self.file.with_suffix(".new").replace(self.file)

    def progress(self):
        return min(1.0, self.seconds / (60 * self.args.minutes))

    def set_rate(self):
        rate = self.args.rate * min(1, (self.steps + 1) / WARM_UP) * 0.5 * (1 + math.cos(math.pi * self.progress()))
        for group in self.optimizer.param_groups:
            group["lr"] = rate + 1e-6

    def step(self, batch):
        self.set_rate()
        maps = tracker_maps(batch.tracker, batch.has_tracker)
        with torch.autocast("cpu", torch.bfloat16, enabled=HAS_BFLOAT16):
            out = self.network(lay_out(batch.image), lay_out(maps))
        loss, error = losses(out, batch)
        self.optimizer.zero_grad(set_to_none=True)
        loss.backward()
        torch.nn.utils.clip_grad_norm_(self.network.parameters(), 1.0)
        self.optimizer.step()
        self.steps += 1
        self.images += len(batch.truth)
        self.follow()
        self.error = error if self.error is None else 0.99 * self.error + 0.01 * error

    @torch.no_grad()
    def follow(self):
        share = 1 - min(DECAY, (self.steps + 1) / (self.steps + 20))
        mean, now = list(self.mean.parameters()), list(self.network.parameters())
        torch._foreach_mul_(mean, 1 - share)
        torch._foreach_add_(mean, now, alpha=share)
        for to, buffer in zip(self.mean.buffers(), self.network.buffers()):
            to.copy_(buffer)

    def run(self):
        source = batches(self.args.program, self.args.seed, self.images, self.args.batch, self.args.people)
        self.network.train()
        last = saved = time.time()
        for batch in source:
            self.step(batch)
            now = time.time()
            self.seconds += now - last
            last = now
            if self.steps % 100 == 0:
                left = self.args.minutes - self.seconds / 60
                print(f"{self.images:8d} images  error {self.error:.2f} px of the crop  {left:.1f} minutes left", flush=True)
            if now - saved > 60 or self.progress() >= 1:
                self.save()
                saved = now
            if self.progress() >= 1:
                return


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", default="build/bin/handcast-training-images", help="the program that makes the images")
    parser.add_argument("--folder", default="out/training", help="folder of the state and the network")
    parser.add_argument("--start", help="an exported network, whose weights are the first ones (default: random)")
    parser.add_argument("--minutes", type=float, default=240, help="duration, the sum of all runs")
    parser.add_argument("--batch", type=int, default=32)
    parser.add_argument("--rate", type=float, default=3e-3, help="the highest learning rate")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--people", type=int, default=200)
    parser.add_argument("--threads", type=int, default=1)
    args = parser.parse_args()
    torch.set_num_threads(args.threads)
    torch.manual_seed(args.seed)
    Path(args.folder).mkdir(parents=True, exist_ok=True)
    training = Training(args)
    try:
        training.run()
    except KeyboardInterrupt:
        training.save()
        raise SystemExit("stopped; the same command continues") from None
    export(training.mean, Path(args.folder) / "handcast.onnx")
    print(f"trained on {training.images} images: {args.folder}/handcast.onnx", flush=True)


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The implementation of scripts/soak. Uses only the standard library."""
import csv
import os
import pathlib
import random
import signal
import sys
import time

from running_rig import Rig, build, number_in, options_parser

SAMPLE_EVERY_S = 5
MOST_MISSED_PERCENT = 1  # more than in quiet: what a busy machine misses anyway is not the kills' doing
MOST_RISE = 0.1
STRETCHES = 10
WARM_UP_SHARE = 0.2  # of the samples, not judged: caches and histories still fill
COLOURS = ("#1b6ca8", "#c1440e", "#3a7d44", "#7b4b94", "#b8860b", "#555555", "#008b8b")


def parse_options():
    parser = options_parser("soak", minutes=30)
    parser.add_argument("--every", type=number_in(0.1, 3600), default=2)
    parser.add_argument("--kill-supervisor", type=number_in(0, 1e6), default=60)
    return parser.parse_args()


def memory_kib(pid):
    """The anonymous memory of a process, and all its resident memory with the rings."""
    sizes = dict(line.split(":", 1) for line in pathlib.Path(f"/proc/{pid}/status").read_text().splitlines())
    return int(sizes["RssAnon"].split()[0]), int(sizes["VmRSS"].split()[0])


def sample(rig, status, start_s, kills):
    row = {"s": round(time.monotonic() - start_s, 1), "kills": kills}
    for name, pid in rig.members(status).items():
        try:
            row[f"{name}_own_kib"], row[f"{name}_rss_kib"] = memory_kib(pid)
            row[f"{name}_fds"] = len(os.listdir(f"/proc/{pid}/fd"))
        except (OSError, KeyError):
            continue  # it is being restarted
    for stream, ring in status["rings"].items():
        row[f"{stream}_hz"] = ring["held_hz"]
    row["light"] = status["rings"]["projection.frames"]["count"]
    row["wanted_hz"] = status["rings"]["projection.frames"]["wanted_hz"] or 0
    row["restarts"] = sum(service["restarts"] for service in status["services"].values())
    return row


def kill(pid):
    try:
        os.kill(pid, signal.SIGKILL)
        return True
    except (OSError, TypeError):
        return False


class Light:
    """Counts missed frames before and during the kills, in the times in which the projector itself lived."""

    def __init__(self):
        self.wanted, self.made = {"quiet": 0.0, "kills": 0.0}, {"quiet": 0, "kills": 0}
        self.before = None
        self.disturbed = False

    def see(self, row, projector, phase):
        last, self.before = self.before, row
        lived = projector["state"] == "ready" and last and projector["uptime_s"] > row["s"] - last["s"]
        if lived and not self.disturbed and row["light"] >= last["light"] and row["wanted_hz"]:
            self.wanted[phase] += (row["s"] - last["s"]) * row["wanted_hz"]
            self.made[phase] += row["light"] - last["light"]
        self.disturbed = False

    def missed_percent(self, phase):
        return max(0.0, 100 * (1 - self.made[phase] / self.wanted[phase])) if self.wanted[phase] else 0.0


def soak(rig, options):
    """Samples the rig until the time is over or the rig has ended. Kills nothing in the first tenth of the time."""
    chance = random.Random(options.seed)
    rows, light, kills = [], Light(), 0
    start_s = time.monotonic()
    end_s = start_s + 60 * options.minutes
    quiet_until_s = start_s + 6 * options.minutes
    next_kill_s, next_sample_s = quiet_until_s, start_s
    next_supervisor_s = quiet_until_s + options.kill_supervisor if options.kill_supervisor else float("inf")
    while time.monotonic() < end_s and rig.process.poll() is None:
        now_s = time.monotonic()
        if now_s >= next_sample_s:
            next_sample_s += SAMPLE_EVERY_S
            if status := rig.status():
                row = sample(rig, status, start_s, kills)
                phase = "kills" if kills else "quiet"
                light.see(row, status["services"]["projector"], phase)
                rows.append({**row, "missed_percent": round(light.missed_percent(phase), 3)})
                print_progress(rows[-1])
        if now_s >= next_kill_s:
            next_kill_s += options.every
            status = rig.status()
            name = chance.choice(sorted(status["services"])) if status else ""
            if status and kill(status["services"][name]["pid"] or None):
                kills += 1
                light.disturbed |= name == "projector"
        if now_s >= next_supervisor_s:
            next_supervisor_s += options.kill_supervisor
            kills += kill(rig.supervisor())
            light.disturbed = True  # the counters of a new supervisor start at 0
        time.sleep(max(0.0, min(next_kill_s, next_sample_s, end_s) - time.monotonic()))
    return rows, light, kills


def print_progress(row):
    own = sum(value for key, value in row.items() if key.endswith("_own_kib"))
    fds = sum(value for key, value in row.items() if key.endswith("_fds"))
    print(f"{row['s']:7.0f} s  {row['kills']:4} kills  own memory {own / 1024:7.1f} MiB  descriptors {fds:4}  "
          f"light {row['projection.frames_hz'] or 0:6.1f} Hz  missed {row['missed_percent']:.2f} %", flush=True)


def slope_per_hour(points):
    """The slope of the straight line through the points (least squares)."""
    n = len(points)
    mean_x, mean_y = sum(x for x, _ in points) / n, sum(y for _, y in points) / n
    spread = sum((x - mean_x) ** 2 for x, _ in points)
    return 3600 * sum((x - mean_x) * (y - mean_y) for x, y in points) / spread if spread else 0.0


def series(rows, key):
    return [(row["s"], row[key]) for row in rows if key in row]


def envelope(points):
    """The highest sample of each of about ten parts: the low samples of processes that were just started do not count."""
    size = max(1, len(points) // STRETCHES)
    return [max(points[i : i + size], key=lambda point: point[1]) for i in range(0, len(points) - size + 1, size)]


def grows(points):
    """True if the line rises by more than a tenth over the run; and its slope per hour."""
    judged = envelope(points[int(len(points) * WARM_UP_SHARE) :])
    if len(judged) < 4:
        return False, 0.0
    slope = slope_per_hour(judged)
    rise = slope / 3600 * (judged[-1][0] - judged[0][0])
    middle = sorted(y for _, y in judged)[len(judged) // 2]
    return rise > MOST_RISE * max(middle, 1), slope


def judge(rows):
    """Prints one line per curve. Returns True if all are flat."""
    keys = sorted({key for row in rows for key in row if key.endswith(("_own_kib", "_fds"))})
    flat = True
    for key in keys:
        growing, slope = grows(series(rows, key))
        flat &= not growing
        values = [y for _, y in series(rows, key)]
        print(f"  {key:<24} {values[0]:>9} -> {values[-1]:>9}   {slope:>+11.1f} an hour  {'GROWS' if growing else 'flat'}")
    return flat


def draw(rows, path):
    panels = [("unshared memory, MiB", "_own_kib", 1 / 1024), ("descriptors", "_fds", 1), ("rates, Hz", "_hz", 1), ("missed frames of the light, %", "missed_percent", 1)]
    width, height, left = 900, 190, 60
    end_s = max(row["s"] for row in rows) or 1
    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height * len(panels)}" font-family="sans-serif" font-size="11">',
             '<rect width="100%" height="100%" fill="white"/>']
    for number, (title, ending, scale) in enumerate(panels):
        keys = sorted({key for row in rows for key in row if key.endswith(ending) and key != "wanted_hz"})
        top = max([row[key] * scale for row in rows for key in keys if row.get(key) is not None] + [1e-9]) * 1.1
        y0 = height * number
        parts.append(f'<text x="{left}" y="{y0 + 16}" font-weight="bold">{title}</text>')
        for step in range(3):
            y = y0 + height - 25 - step * (height - 55) / 2
            parts.append(f'<line x1="{left}" x2="{width - 170}" y1="{y:.0f}" y2="{y:.0f}" stroke="#ddd"/>'
                         f'<text x="{left - 6}" y="{y + 4:.0f}" text-anchor="end">{top * step / 2:.3g}</text>')
        for i, key in enumerate(keys):
            colour = COLOURS[i % len(COLOURS)]
            points = " ".join(f"{left + row['s'] / end_s * (width - 170 - left):.1f},{y0 + height - 25 - row[key] * scale / top * (height - 55):.1f}"
                              for row in rows if row.get(key) is not None)
            parts.append(f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="1.3"/>'
                         f'<text x="{width - 162}" y="{y0 + 40 + 14 * i}" fill="{colour}">{key.removesuffix(ending) or key}</text>')
    parts.append(f'<text x="{width - 170}" y="{height * len(panels) - 8}" text-anchor="end">{end_s:.0f} s</text></svg>')
    path.write_text("\n".join(parts))


def write_csv(rows, path):
    columns = list(dict.fromkeys(key for row in rows for key in row))
    with open(path, "w", newline="") as file:
        writer = csv.DictWriter(file, columns)
        writer.writeheader()
        writer.writerows(rows)


def main():
    options = parse_options()
    build()
    options.out.mkdir(parents=True, exist_ok=True)
    rig = Rig(options.rig, options.set, open(options.out / "rig.log", "w"))
    try:
        rig.wait_until_ready()
        rows, light, kills = soak(rig, options)
        died = rig.process.poll()
    finally:
        code = rig.stop()
    if not rows:
        sys.exit("soak: nothing was sampled")
    write_csv(rows, options.out / "soak.csv")
    draw(rows, options.out / "soak.svg")
    flat = judge(rows)
    quiet, stormy = light.missed_percent("quiet"), light.missed_percent("kills")
    enough_light = stormy <= quiet + MOST_MISSED_PERCENT
    print(f"{kills} kills in {rows[-1]['s'] / 60:.1f} minutes; memory and descriptors {'flat' if flat else 'GROW'}; "
          f"light missed {stormy:.2f} % while others were killed, {quiet:.2f} % before; the rig {'ended well' if code == 0 and died is None else 'DIED'}; "
          f"{options.out}/soak.csv, soak.svg")
    sys.exit(0 if flat and enough_light and code == 0 and died is None else 1)


if __name__ == "__main__":
    main()

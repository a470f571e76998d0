#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The implementation of scripts/night. Uses only the standard library."""
import collections
import contextlib
import csv
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

import running_rig
from running_rig import HANDCAST, ROOT, Rig, options_parser
from storm import Folder

DARK_S = 0.25
WANTED_HZ = 60
LEAST_HZ = 0.8 * WANTED_HZ  # before the first fault: a computer that is busier than this shows nothing of the rig
CALM = 0.1  # of the time, at both ends
MOST_GROWTH = 0.01
LIBRARIES = HANDCAST.parent.parent / "lib"
# Whose dark seconds are their own: no light without a projector, or without its display.
DARK_BY_NATURE = ("kill projector", "stop projector", "display off", "display server dies")
SETTINGS = [f"camera.rate_hz={WANTED_HZ}", f"projector.rate_hz={WANTED_HZ}", "projector.process.standby=true", "pose.process.standby=true", "watch.enabled=true"]
DISPLAY = ROOT / "tests/dummy_display.conf"


class Display:
    """An X server with a monitor in memory, DUMMY1, beside a primary one."""

    def __init__(self, out):
        self.name, self.log = f":{1000 + os.getpid() % 50_000}", out / "xorg.log"
        self.server = None
        os.environ["DISPLAY"] = self.name
        self.works = pathlib.Path("/usr/lib/xorg/Xorg").exists() and shutil.which("xrandr") is not None and self.start()

    def xrandr(self, *words):
        return subprocess.run(["xrandr", *words], capture_output=True).returncode == 0

    def start(self):
        words = ["-config", DISPLAY, "-logfile", self.log, "-noreset", "-novtswitch", "-sharevts", "-nolisten", "tcp"]
        with open(self.log.with_suffix(".out"), "w") as log:
            self.server = subprocess.Popen(["/usr/lib/xorg/Xorg", *words, self.name], stdout=log, stderr=log)
        limit_s = time.monotonic() + 20
        while not self.xrandr("--query") and self.server.poll() is None and time.monotonic() < limit_s:
            time.sleep(0.05)
        return self.xrandr("--addmode", "DUMMY1", "800x600") and self.switch(True)

    def switch(self, on):
        words = ("--mode", "800x600", "--right-of", "DUMMY0") if on else ("--off",)
        return self.xrandr("--output", "DUMMY1", *words) and self.xrandr("--query")

    def end(self):
        if self.server:
            self.server.kill()
            self.server.wait()


class Night:
    """A rig and its faults, each of which is over, but for what the rig makes of it, when its method returns."""

    def __init__(self, options, stack):
        self.chance, self.out = random.Random(options.seed), options.out
        self.folder = Folder(64 << 20)
        stack.callback(self.folder.close)
        runtime = stack.enter_context(tempfile.TemporaryDirectory(prefix="handcast-night-"))
        self.display = Display(options.out)
        stack.callback(self.display.end)
        self.plug, self.jump = options.out / "plugged_in", options.out / "clock_jump"
        self.plug.unlink(missing_ok=True)
        self.jump.write_bytes(bytes(8))
        rig_file = shutil.copy(options.rig, self.folder.path)
        libraries = [LIBRARIES / f"libhandcast_{name}.so" for name in ("emulated_webcam", "jumping_clock")]
        settings = SETTINGS + ["camera.backend=v4l2"] + (["projector.backend=window"] if self.display.works else []) + options.set
        os.environ.update(XDG_RUNTIME_DIR=runtime, TMPDIR=str(self.folder.path), HANDCAST_CLOCK_JUMP=str(self.jump),
                          HANDCAST_EMULATED_WEBCAM=str(self.plug), LD_PRELOAD=":".join(map(str, libraries)))
        self.rig = Rig(rig_file, settings, open(options.out / "rig.log", "w"))
        del os.environ["LD_PRELOAD"]
        stack.callback(lambda: self.rig.process.poll() is None and self.rig.stop())
        self.faults, self.failures = [], []
        self.kinds = [("kill", 8, self.kill), ("stop", 2, self.stop), ("clock jump", 2, self.jump_clock), ("camera unplugged", 1, self.unplug)]
        if self.folder.mounted:
            self.kinds.append(("disk full", 2, self.fill_disk))
        if self.display.works:
            self.kinds += [("display off", 1, self.switch_display), ("display server dies", 1, self.end_display)]
        else:
            print("night: no X server here, whose display could go off: the light is the twin's")
        with self.fault("late camera"):
            self.wait("the rig without its camera", lambda: self.states().get("projector") == "ready")
            time.sleep(2)
            self.plug.touch()
            self.wait("the late camera", lambda: self.states().get("camera") == "ready")
            self.swap("twin")
        self.eye = subprocess.Popen([HANDCAST.parent / "handcast_night_eye"], env=self.rig.environment, stdout=open(options.out / "eye.txt", "w"))
        stack.callback(self.eye.kill)

    @contextlib.contextmanager
    def fault(self, kind):
        start_s = time.monotonic()
        yield
        self.faults.append({"fault": kind, "from_s": round(start_s, 3), "to_s": round(time.monotonic(), 3)})

    def states(self):
        status = self.rig.status()
        return {name: service["state"] for name, service in status["services"].items()} if status else {}

    def wait(self, what, condition):
        limit_s = time.monotonic() + 60
        while not condition():
            if time.monotonic() > limit_s:
                self.failures.append(f"{what}: not within 60 s")
                return
            time.sleep(0.1)

    def is_lit(self):
        seen = (self.out / "eye.txt").read_text().splitlines()
        at_s, lit = seen[-1].split() if seen and seen[-1].count(" ") else ("0", "0")
        return int(lit or 0) > 0 and time.monotonic() - float(at_s) < DARK_S

    def pids(self):
        status = self.rig.status()
        return {name: pid for name, pid in self.rig.members(status).items() if name != "keeper"} if status else {}

    def strike(self):
        _, _, act = self.chance.choices(self.kinds, [weight for _, weight, _ in self.kinds])[0]
        act()

    def hit(self, what, number):
        """Sends a signal to a service or the supervisor. Returns its pid; None if it was being restarted."""
        pids = self.pids()
        name = self.chance.choice(sorted(pids)) if pids else ""
        with self.fault(f"{what} {name}"), contextlib.suppress(OSError, KeyError):
            os.kill(pids[name], number)
            return pids[name]

    def kill(self):
        self.hit("kill", signal.SIGKILL)

    def stop(self):
        pid = self.hit("stop", signal.SIGSTOP)
        time.sleep(self.chance.uniform(0.5, 4))
        with contextlib.suppress(OSError, TypeError):
            os.kill(pid, signal.SIGCONT)

    def fill_disk(self):
        with self.fault("disk full"):
            if not self.folder.fill():
                self.failures.append("the disk could not be filled")
            self.rig.run("set", f"content.shading={self.chance.random():.3f}")
            if self.rig.run("save")[0] == 0:
                self.failures.append("`save` on a full disk did not fail")
            time.sleep(self.chance.uniform(1, 4))
            self.folder.relax()

    def jump_clock(self):
        with self.fault("clock jump"):
            seconds = int(self.chance.choice([-1, 1]) * 10 ** self.chance.uniform(0, 7))
            self.jump.write_bytes(seconds.to_bytes(8, sys.byteorder, signed=True))

    def swap(self, backend):
        if self.rig.run("swap", "camera", backend)[0] != 0:
            self.failures.append(f"the camera was not swapped to {backend}")

    def unplug(self):
        with self.fault("camera unplugged"):
            self.rig.run("set", "cascade.mask.threshold=1")  # its images are grey, and no hand is in them
            self.swap("v4l2")
            self.plug.unlink()
            time.sleep(self.chance.uniform(1, 4))
            self.plug.touch()
            self.wait("the camera that was plugged in again", lambda: self.states().get("camera") == "ready")
            self.swap("twin")
            self.rig.run("set", "cascade.mask.threshold")

    def switch_display(self):
        with self.fault("display off"):
            self.display.switch(False)
            time.sleep(self.chance.uniform(1, 4))
            self.display.switch(True)
            self.wait("the light on a display that is on again", self.is_lit)

    def end_display(self):
        with self.fault("display server dies"):
            self.display.end()
            time.sleep(self.chance.uniform(0, 2))
            if not self.display.start():
                self.failures.append("the display server did not start again")
            self.wait("the light on a display that was started again", self.is_lit)

    def memory_kib(self):
        """By process: its memory with its share of what it has in common with others, and what is its own."""
        sizes, status = {}, self.rig.status()
        standbys = {f"standby of {name}": service["standby"] for name, service in status["services"].items() if service["standby"]}
        for name, pid in {**self.rig.members(status), **standbys}.items():
            lines = dict(line.split(":", 1) for line in pathlib.Path(f"/proc/{pid}/smaps_rollup").read_text().splitlines()[1:])
            sizes[name] = [int(lines[key].split()[0]) for key in ("Pss", "Pss_Anon")]
        return {**sizes, "all": [sum(column) for column in zip(*sizes.values())]}


def dark_times(eye, end_s):
    """(from, to) of each time without a lit frame; `end_s`: when the rig was told to stop."""
    times, last_s = [], None
    for line in eye.read_text().splitlines():
        at_s, lit = line.split()
        if int(lit) == 0 or float(at_s) > end_s:
            continue
        if last_s is not None and float(at_s) - last_s > DARK_S:
            times.append((last_s, float(at_s)))
        last_s = float(at_s)
    return times + [(last_s, end_s)] if last_s and end_s - last_s > DARK_S else times


def calm_hz(eye, until_s):
    """The rate of the light before the first fault of the night."""
    times = [float(line.split()[0]) for line in eye.read_text().splitlines()]
    calm = [at_s for at_s in times if at_s < until_s]
    return len(calm) / (until_s - calm[0]) if calm else 0


def owner_of(dark, faults):
    """The last fault that had begun when the light went, or soon after its last frame: hands fade first."""
    begun = [fault for fault in faults if fault["from_s"] < dark[0] + DARK_S]
    return begun[-1]["fault"] if begun else "nothing"


def report(night, seconds, dark, hz, early, late, code):
    """Prints the tables. Returns whether all is well."""
    if hz < LEAST_HZ:
        night.failures.append(f"the computer is too busy to judge: {hz:.0f} Hz of light before the first fault, not {WANTED_HZ}")
    counts, lost, worst = collections.Counter(fault["fault"] for fault in night.faults), collections.Counter(), collections.Counter()
    for time_s in dark:
        owner = owner_of(time_s, night.faults)
        lost[owner] += time_s[1] - time_s[0]
        worst[owner] = max(worst[owner], time_s[1] - time_s[0])
    print(f"\n{'fault':<24} {'times':>5} {'dark s':>8} {'longest':>8}")
    for fault in sorted({*counts, *lost}):
        print(f"{fault:<24} {counts[fault]:>5} {lost[fault]:>8.2f} {worst[fault]:>8.2f}")
    print(f"\n{'memory (PSS), KiB':<24} {'at 10 %':>9} {'at the end':>11}   {'of it its own':>14}")
    for name, (after, own_after) in late.items():
        before, own_before = early.get(name, (after, own_after))
        print(f"{name:<24} {before:>9} {after:>11} {100 * (after / before - 1):+7.2f} %  {own_before:>9} {own_after:>9} {100 * (own_after / own_before - 1):+7.2f} %")
    growth = late["all"][0] / early["all"][0] - 1
    foreign_s = sum(seconds_ for owner, seconds_ in lost.items() if owner not in DARK_BY_NATURE)
    well = foreign_s == 0 and growth <= MOST_GROWTH and code == 0 and not night.failures
    print(f"\n{len(night.faults)} faults in {seconds / 60:.1f} minutes: {foreign_s:.2f} dark s beyond those of projector and display, "
          f"memory {100 * growth:+.2f} %, the rig {'ended well' if code == 0 else 'DIED'}; {'; '.join([*night.failures, ''])}{'well' if well else 'NOT WELL'}")
    return well


def main():
    signal.signal(signal.SIGINT, signal.default_int_handler)
    options = options_parser("night", minutes=30).parse_args()
    running_rig.build()
    options.out = options.out.resolve()
    options.out.mkdir(parents=True, exist_ok=True)
    with contextlib.ExitStack() as stack:
        night = Night(options, stack)
        start_s, seconds = time.monotonic(), 60 * options.minutes
        time.sleep(CALM * seconds)
        early, calm_until_s = night.memory_kib(), time.monotonic()
        while time.monotonic() < start_s + (1 - CALM) * seconds and night.rig.process.poll() is None:
            night.strike()
            time.sleep(night.chance.uniform(0.5, 2.5))
        night.wait("the rig", lambda: night.states() and set(night.states().values()) == {"ready"})
        time.sleep(max(0.0, start_s + seconds - time.monotonic()))
        late, end_s = night.memory_kib(), time.monotonic()
        code = night.rig.stop()
    with open(options.out / "faults.csv", "w", newline="") as file:
        writer = csv.DictWriter(file, ["fault", "from_s", "to_s"])
        writer.writeheader()
        writer.writerows(night.faults)
    eye = options.out / "eye.txt"
    sys.exit(0 if report(night, seconds, dark_times(eye, end_s), calm_hz(eye, calm_until_s), early, late, code) else 1)


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The implementation of scripts/storm. Uses only the standard library."""
import collections
import csv
import os
import pathlib
import random
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time

from running_rig import HANDCAST, Rig, build, options_parser, processes_of

LONGEST_STOP_S = 5
DOUBLE_AFTER_S = 3  # a replacement and the process that it replaces may overlap for less
SETTINGS = ["camera.rate_hz=60", "projector.rate_hz=60", "projector.process.standby=true"]
STOPS = ["down", "ctrl-c", "ctrl-c three times"]
NOBODY = 65534
AS_NOBODY = ["setpriv", f"--reuid={NOBODY}", f"--regid={NOBODY}", "--clear-groups"]


def role_of(arguments):
    """keeper, supervisor, or the name of a service; "" for commands such as `handcast down`."""
    program = pathlib.Path(arguments[0]).name
    if program == "handcast":
        if "--hold" in arguments:
            return "descriptor store"
        return "supervisor" if "--kept" in arguments else "keeper" if "up" in arguments[1:2] else ""
    if "--as" in arguments:
        return arguments[arguments.index("--as") + 1]
    return program.removeprefix("handcast-") if program.startswith("handcast-") else ""


class Folder:
    """A small file system for the files of a rig, or a plain folder where none may be mounted."""

    def __init__(self, size=1 << 16):
        self.size, self.path = size, pathlib.Path(tempfile.mkdtemp(prefix="handcast-storm-"))
        self.path.chmod(0o777)
        mount = ["mount", "-t", "tmpfs", "-o", f"size={size}", "tmpfs", self.path]
        self.mounted = subprocess.run(mount, capture_output=True).returncode == 0
        if not self.mounted:
            print("no file system may be mounted here; the disk is not filled")

    def fill(self):
        """Returns whether the file system could be filled."""
        with open(self.path / "full", "wb", buffering=0) as file:
            try:
                for _ in range(2 * self.size >> 16 if self.mounted else 0):
                    file.write(bytes(1 << 16))
            except OSError:
                return True
        return False

    def relax(self):
        """There is room again."""
        (self.path / "full").unlink(missing_ok=True)

    def empty(self):
        for entry in self.path.iterdir():
            shutil.rmtree(entry) if entry.is_dir() else entry.unlink()
        return True

    def close(self):
        if self.mounted:
            subprocess.run(["umount", self.path], capture_output=True)
        shutil.rmtree(self.path, ignore_errors=True)


class Programs:
    """A copy of the programs for an ordinary user, in which some services have capabilities."""

    def __init__(self):
        self.path = pathlib.Path(tempfile.mkdtemp(prefix="handcast-storm-"))
        self.path.chmod(0o755)
        (self.path / "bin").mkdir()
        for program in [HANDCAST, *HANDCAST.parent.glob("handcast-*")]:
            shutil.copy2(program, self.path / "bin")
        for part in ("share", "lib/handcast"):
            if (HANDCAST.parent.parent / part).is_dir():
                shutil.copytree(HANDCAST.parent.parent / part, self.path / part)
        self.handcast = self.path / "bin/handcast"
        self.works = os.geteuid() == 0 and self.give_rights(["camera"])
        if not self.works:
            print("storm: no capabilities and no other users here: both need the superuser and setcap")

    def give_rights(self, services):
        """Gives exactly these services CAP_SYS_NICE. Returns whether it worked."""
        for program in self.path.glob("bin/handcast-*"):
            subprocess.run(["setcap", "-r", program], capture_output=True)
        programs = [word for service in services for word in ("cap_sys_nice+ep", self.path / f"bin/handcast-{service}")]
        return shutil.which("setcap") is not None and subprocess.run(["setcap", *programs], capture_output=True).returncode == 0

    def close(self):
        shutil.rmtree(self.path, ignore_errors=True)


class Doubles:
    """Notices a role that two processes have for longer than a replacement takes."""

    def __init__(self):
        self.since = {}
        self.found = []

    def look(self, processes, stopped):
        """`stopped`: pids that the storm has stopped; a hung supervisor and its successor do not count as two."""
        counts = collections.Counter(role for pid, arguments in processes.items() if pid not in stopped and (role := role_of(arguments)))
        now = time.monotonic()
        for role, count in counts.items():
            allowed = 2 if role not in ("keeper", "supervisor") else 1  # a worker and its standby
            if count <= allowed:
                self.since.pop(role, None)
            elif now - self.since.setdefault(role, now) > DOUBLE_AFTER_S:
                self.found.append(f"{count} x {role}")
                self.since.pop(role)


class Storm:
    """One life of a rig, from `up` to darkness."""

    def __init__(self, options, chance, folder, programs):
        self.chance, self.folder = chance, folder
        self.events = collections.Counter()
        self.doubles = Doubles()
        self.stopped, self.idle = {}, []
        os.environ.update(XDG_RUNTIME_DIR=str(folder.path), TMPDIR=str(folder.path))
        self.user, self.neighbour, self.keeper_lives = os.getuid(), None, True
        self.nohup = chance.random() < 0.5
        handcast, before, settings = HANDCAST, ["nohup"] if self.nohup else [], SETTINGS + options.set
        log = open(options.out / "rig.log", "a")
        self.how = chance.choice(["plain", "capabilities", "two users"]) if programs.works else "plain"
        if self.how != "plain":
            self.user, handcast, before = NOBODY, programs.handcast, before + AS_NOBODY
        if self.how == "capabilities":
            services = ["camera", "pose", "landmarks", "projector", "observer"]
            programs.give_rights(chance.sample(services, chance.randint(1, len(services))))
        if self.how == "two users":
            programs.give_rights([])
            self.neighbour = Rig(options.rig, ["camera.rate_hz=30", "projector.rate_hz=30"], log)
            self.neighbour.wait_until_ready()
        self.rig = Rig(options.rig, settings, log, handcast, before)

    def processes(self):
        return processes_of(self.rig.scope, self.user)

    def losses(self):
        """What the storm must not have ended: the light, while its keeper lives, and the rig of another user."""
        lost = []
        limit_s = time.monotonic() + 15  # a supervisor that was just killed, or a keeper that is stopped
        while self.keeper_lives and not services_in(self.processes()) and time.monotonic() < limit_s:
            self.let_go_on()
            time.sleep(0.1)
        if self.keeper_lives and not services_in(self.processes()):
            lost.append("all services")
        if self.neighbour:
            now = self.neighbour.status()
            if not now or any(service["restarts"] for service in now["services"].values()):
                lost.append("the rig of the other user")
            self.neighbour.stop()
        return lost

    def victim(self, *roles):
        found = [pid for pid, arguments in self.processes().items() if (role := role_of(arguments)) and (not roles or role in roles)]
        return self.chance.choice(found) if found else None

    def signal(self, pid, number):
        """Returns whether there was such a process."""
        try:
            os.kill(pid, number)
            return True
        except (OSError, TypeError):
            return False

    def strike(self):
        """One event."""
        event = self.chance.choices(["kill", "stop", "kill supervisor", "stop supervisor", "kill keeper", "stop keeper", "disk full", "folder gone", "idle connections", "hang up"],
                                    [8, 4, 2, 2, 1, 1, 1, 1, 1, 2 if self.nohup else 0])[0]
        if event == "disk full":
            happened = self.folder.fill()
        elif event == "folder gone":
            happened = self.folder.empty()
        elif event == "idle connections":
            happened = self.connect_idly() > 0
        elif event == "hang up":
            happened = any([self.signal(self.victim(role), signal.SIGHUP) for role in ("keeper", "supervisor")])
        else:
            what, _, whom = event.partition(" ")
            happened = self.hit(self.victim(*([whom] if whom else [])), what)
        self.events[event] += happened

    def hit(self, pid, what):
        """Kills a process, or stops it for some seconds. Returns whether it lived."""
        self.keeper_lives &= what != "kill" or role_of(self.processes().get(pid, [""])) != "keeper"
        hit = self.signal(pid, signal.SIGKILL if what == "kill" else signal.SIGSTOP)
        if hit and what == "stop":
            self.stopped[pid] = time.monotonic() + self.chance.uniform(0.5, 8)
        return hit

    def connect_idly(self):
        """Connects to the control socket and asks nothing. Returns the number of connections."""
        ours = f"@handcast-{self.user}/{self.rig.scope}/"
        addresses = [line.split()[-1] for line in pathlib.Path("/proc/net/unix").read_text().splitlines() if ours in line]
        before = len(self.idle)
        for address in addresses[:1] * 64:
            connection = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
            connection.setblocking(False)
            try:
                connection.connect("\0" + address.removeprefix("@"))
            except OSError:
                continue
            self.idle.append(connection)
        return len(self.idle) - before

    def let_go_on(self):
        for pid, until_s in list(self.stopped.items()):
            if time.monotonic() >= until_s:
                self.signal(pid, signal.SIGCONT)
                del self.stopped[pid]

    def rage(self, seconds):
        end_s = time.monotonic() + seconds
        next_strike_s = time.monotonic() + 1
        while time.monotonic() < end_s:
            if time.monotonic() >= next_strike_s:
                self.strike()
                next_strike_s += self.chance.uniform(0.1, 2)
            self.let_go_on()
            self.doubles.look(self.processes(), self.stopped)
            time.sleep(0.05)

    def end(self):
        """Stops the rig, with whatever is stopped or dead. Returns how, the time until darkness, and the processes that are left."""
        how = self.chance.choice(STOPS)
        begin_s = time.monotonic()
        keepers = [pid for pid, arguments in self.processes().items() if role_of(arguments) == "keeper" and pid not in self.stopped]
        if how == "down" or not keepers:
            how = "down"
            self.rig.run("down")
        else:
            for _ in range(3 if "three" in how else 1):
                self.signal(keepers[0], signal.SIGINT)
                time.sleep(0.1)
        while services_in(self.processes()) and time.monotonic() < begin_s + 20:
            time.sleep(0.02)
        dark_s = time.monotonic() - begin_s
        left = self.wait_for_the_rest()
        for connection in self.idle:
            connection.close()
        return how, dark_s, left

    def wait_for_the_rest(self):
        """Keepers and supervisors end after the services. What the storm itself has stopped is continued first. Kills what is left."""
        for pid in self.stopped:
            self.signal(pid, signal.SIGCONT)
        limit_s = time.monotonic() + 10
        while self.processes() and time.monotonic() < limit_s:
            self.rig.process.poll()
            time.sleep(0.05)
        left = self.processes()
        for pid in left:
            self.signal(pid, signal.SIGKILL)
        self.rig.process.wait()
        return [" ".join(arguments[:2]) for arguments in left.values()]


def services_in(processes):
    return [pid for pid, arguments in processes.items() if role_of(arguments) not in ("", "keeper", "supervisor")]


def percentile(values, share):
    return sorted(values)[min(len(values) - 1, int(share * len(values)))]


def main():
    # A shell's job in the background ignores it, and a rig respects that.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    options = options_parser("storm", minutes=10).parse_args()
    build()
    options.out.mkdir(parents=True, exist_ok=True)
    chance, folder, programs = random.Random(options.seed), Folder(), Programs()
    rows, events = [], collections.Counter()
    end_s = time.monotonic() + 60 * options.minutes
    try:
        while time.monotonic() < end_s:
            storm = Storm(options, chance, folder, programs)
            try:
                storm.rage(chance.uniform(4, 20))
                lost = storm.losses()
                how, dark_s, left = storm.end()
            except BaseException:
                storm.wait_for_the_rest()
                raise
            events += storm.events
            rows.append({"life": len(rows) + 1, "as": storm.how + (", nohup" if storm.nohup else ""), "events": storm.events.total(), "lost": "; ".join(lost), "stopped by": how, "dark after s": round(dark_s, 2), "left": "; ".join(left), "doubles": "; ".join(storm.doubles.found)})
            print("  ".join(f"{key}: {value}" for key, value in rows[-1].items()), flush=True)
    finally:
        folder.close()
        programs.close()
    with open(options.out / "storm.csv", "w", newline="") as file:
        writer = csv.DictWriter(file, rows[0])
        writer.writeheader()
        writer.writerows(rows)
    times = [row["dark after s"] for row in rows]
    late = sum(time_s > LONGEST_STOP_S for time_s in times)
    lost, left, doubles = (sum(bool(row[key]) for row in rows) for key in ("lost", "left", "doubles"))
    print(f"{sum(events.values())} events in {len(rows)} lives: " + ", ".join(f"{count} {event}" for event, count in events.most_common()))
    print(f"dark after p50 {percentile(times, 0.5):.2f} s, p99 {percentile(times, 0.99):.2f} s, max {max(times):.2f} s; "
          f"later than {LONGEST_STOP_S} s: {late}; lives that lost the light: {lost}; with processes left: {left}; with doubles: {doubles}")
    sys.exit(1 if late or lost or left or doubles else 0)


if __name__ == "__main__":
    main()

# SPDX-License-Identifier: Apache-2.0
"""A running rig and its processes, for scripts/soak, scripts/storm and scripts/night. Uses only the standard library."""
import argparse
import json
import os
import pathlib
import signal
import subprocess
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
HANDCAST = pathlib.Path(os.environ.get("HANDCAST_BIN", ROOT / "build/bin")).resolve() / "handcast"


def number_in(least, most):
    def parse(word):
        try:
            if least <= float(word) <= most:
                return float(word)
        except ValueError:
            pass
        raise argparse.ArgumentTypeError(f"'{word}' is no number from {least:g} to {most:g}")
    return parse


def file_that_exists(word):
    if not pathlib.Path(word).is_file():
        raise argparse.ArgumentTypeError(f"there is no file '{word}'")
    return word


def options_parser(name, minutes):
    """The options that scripts which run a rig for some minutes have in common. `name`: of the script, and of the folder in out/."""
    parser = argparse.ArgumentParser(prog=name, usage=f"scripts/{name} --help", allow_abbrev=False)
    parser.add_argument("--minutes", type=number_in(0.01, 1e6), default=minutes)
    parser.add_argument("--rig", type=file_that_exists, default=ROOT / "config/rigs/twin.toml")
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "out" / name)
    parser.add_argument("--set", action="append", default=[], metavar="path=value")
    parser.add_argument("--seed", type=int, default=1)
    return parser


def build():
    """Builds the programs of a rig. Ends this process with 1 if that fails."""
    if subprocess.run([ROOT / "scripts/build"]).returncode != 0:
        raise SystemExit(1)


class Rig:
    """A process of `handcast up` in a scope of its own.

    `handcast`: the program; `before`: the words of a command that starts it, e.g. as another user.
    """

    def __init__(self, rig_file, settings, log, handcast=HANDCAST, before=()):
        self.handcast, self.before = handcast, [word for word in before if word != "nohup"]
        self.scope = f"{pathlib.Path(log.name).stem}-{os.getpid()}"
        self.environment = {**os.environ, "HANDCAST_SCOPE": self.scope}
        self.log = log
        words = [word for setting in settings for word in ("--set", setting)]
        self.process = subprocess.Popen([*before, handcast, "up", rig_file, *words], env=self.environment, stdout=log, stderr=log)

    def run(self, *words, patience_s=30):
        """Runs `handcast WORDS`. Returns the exit code, None if it did not end in time, and the output."""
        try:
            answer = subprocess.run([*self.before, self.handcast, *words], env=self.environment, capture_output=True, text=True, timeout=patience_s)
        except subprocess.TimeoutExpired:
            return None, ""
        return answer.returncode, answer.stdout

    def status(self):
        """None if no supervisor answers. That a service is not well is an exit code, too."""
        _, output = self.run("status", "--json")
        return json.loads(output) if output else None

    def wait_until_ready(self):
        limit = time.monotonic() + 60
        while time.monotonic() < limit and self.process.poll() is None:
            now = self.status()
            if now and all(service["state"] == "ready" for service in now["services"].values()):
                return now
            time.sleep(0.1)
        raise SystemExit(f"the rig did not become ready; see {self.log.name}")

    def supervisor(self):
        """The keeper's child that runs `handcast up`: services lead their own sessions. None if there is no keeper."""
        for pid in children_of(self.process.pid):
            if name_of(pid).startswith("handcast") and session_of(pid) == session_of(self.process.pid):
                return pid
        return None

    def members(self, status):
        """The pids by name."""
        members = {name: service["pid"] for name, service in status["services"].items() if service["pid"]}
        supervisor = self.supervisor()
        return {**members, "keeper" if supervisor else "supervisor": self.process.pid, **({"supervisor": supervisor} if supervisor else {})}

    def stop(self):
        self.process.send_signal(signal.SIGINT)
        try:
            code = self.process.wait(30)
        except subprocess.TimeoutExpired:
            self.process.kill()
            code = None
        return code


def children_of(pid):
    try:
        return [int(child) for child in pathlib.Path(f"/proc/{pid}/task/{pid}/children").read_text().split()]
    except OSError:
        return []


def name_of(pid):
    try:
        return pathlib.Path(f"/proc/{pid}/comm").read_text().strip()
    except OSError:
        return ""


def session_of(pid):
    """The session of a process; None if it has died."""
    try:
        return os.getsid(pid)
    except OSError:
        return None


def environment_of(pid):
    """The environment of a process; empty if it has died."""
    try:
        return dict(entry.split("=", 1) for entry in pathlib.Path(f"/proc/{pid}/environ").read_text(errors="replace").split("\0") if "=" in entry)
    except OSError:
        return {}


def arguments_of(pid):
    """The command line of a process; empty if it has died."""
    try:
        return pathlib.Path(f"/proc/{pid}/cmdline").read_text(errors="replace").split("\0")[:-1]
    except OSError:
        return []


def user_of(pid):
    """The real user of a process, which does not change with its capabilities; None if it has died."""
    try:
        lines = pathlib.Path(f"/proc/{pid}/status").read_text(errors="replace").splitlines()
        return next(int(line.split()[1]) for line in lines if line.startswith("Uid:"))
    except (OSError, StopIteration):
        return None


def processes_of(scope, user=None):
    """The command lines of all processes of a scope, by pid; `user`: only those of this one."""
    pids = [int(entry.name) for entry in pathlib.Path("/proc").iterdir() if entry.name.isdigit()]
    return {pid: arguments for pid in pids if environment_of(pid).get("HANDCAST_SCOPE") == scope and (arguments := arguments_of(pid))
            and user in (None, user_of(pid))}

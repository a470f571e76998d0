#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A rig that systemd restarts is a new one, although systemd has kept its descriptors. usage: restart_test.py HANDCAST"""
import array
import os
import pathlib
import socket
import subprocess
import sys
import tempfile
import threading
import time
import unittest

PATIENCE_S = 30
FIRST_PASSED = 3  # SD_LISTEN_FDS_START
PARKED = 500      # numbers that nothing has, for the way there


class Systemd:
    """What systemd is to a unit: a socket for its notices, and a store of its descriptors (sd_notify(3), FDSTORE=1)."""

    def __init__(self, folder):
        self.path = str(folder / "notify")
        self.socket = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        self.socket.bind(self.path)
        self.store = {}
        threading.Thread(target=self.listen, daemon=True).start()

    def listen(self):
        while True:
            notice, passed, _, _ = self.socket.recvmsg(4096, socket.CMSG_SPACE(4))
            words = dict(line.split("=", 1) for line in notice.decode().splitlines())
            if "FDSTOREREMOVE" in words and words["FDNAME"] in self.store:
                os.close(self.store.pop(words["FDNAME"]))
            if "FDSTORE" in words:
                self.store[words["FDNAME"]] = array.array("i", passed[0][2])[0]

    def start(self, command, environment):
        """Starts a unit's command with all that is stored. Returns the process."""
        stored = dict(self.store)
        words = {"NOTIFY_SOCKET": self.path, "LISTEN_FDS": str(len(stored)), "LISTEN_FDNAMES": ":".join(stored)}
        # Numbers from 3 on, and the variable with the number of the process itself.
        moves = "; ".join(f"exec {FIRST_PASSED + i}<&{PARKED + i}" for i in range(len(stored)))
        return subprocess.Popen(["bash", "-c", f"{moves or ':'}; export LISTEN_PID=$$; exec \"$@\"", "-", *command],
                                env=environment | words, preexec_fn=lambda: [os.dup2(fd, PARKED + i) for i, fd in enumerate(stored.values())],
                                close_fds=False, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)


class Restart(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)
        self.environment = os.environ | {"HANDCAST_SCOPE": scratch.name}
        self.rig = self.folder / "show.toml"
        self.systemd = Systemd(self.folder)

    def run_once(self, settings, command):
        """Runs the rig until it is up, calls handcast, and stops the rig as systemd would. Returns its log and what handcast printed."""
        self.rig.write_text("desk.page.listen = \"\"\ncamera.rate_hz = 30\nprojector.rate_hz = 30\nobserver.enabled = false\n" + settings)
        unit = self.systemd.start([HANDCAST, "up", str(self.rig), "--no-keeper"], self.environment)
        self.addCleanup(unit.kill)
        lines = []
        reader = threading.Thread(target=lambda: lines.extend(unit.stderr), daemon=True)
        reader.start()
        end = time.monotonic() + PATIENCE_S
        while not any("is up" in line for line in lines) and unit.poll() is None:
            self.assertLess(time.monotonic(), end, "".join(lines))
            time.sleep(0.05)
        done = subprocess.run([HANDCAST, *command], env=self.environment, capture_output=True, text=True, check=False)
        unit.terminate()
        self.assertEqual(unit.wait(PATIENCE_S), 0, "".join(lines))
        reader.join()
        unit.stderr.close()
        self.assertEqual(done.returncode, 0, done.stderr)
        return "".join(lines), done.stdout

    def test_has_nothing_of_the_run_before(self):
        self.run_once("", ["blackout", "on"])
        self.assertIn("supervisor.state", self.systemd.store)
        log, blackout = self.run_once("", ["get", "light.blackout"])
        self.assertIn("light.blackout = false", blackout)
        self.assertNotIn("died", log)
        log, _ = self.run_once("content.width_px = 320\n", ["status"])
        self.assertNotIn("taken over", log)


if __name__ == "__main__":
    HANDCAST = sys.argv.pop(1)
    unittest.main()

# SPDX-License-Identifier: Apache-2.0
"""Headless Chromium: opens pages, asks them in JavaScript, and takes their pictures. Uses only the standard library."""
import base64
import contextlib
import json
import os
import select
import subprocess
import tempfile
import time

PATIENCE_S = 20


class PageLeft(AssertionError):
    """The page that was asked was left meanwhile."""


class Browser:
    """Chromium, driven by its DevTools protocol through two pipes.

    `folder`: an empty one for its files. `is_expected`: which errors, as entries of the protocol's log, are no `faults`.
    """

    def __init__(self, program, folder, is_expected=lambda entry: False):
        self.is_expected = is_expected
        to_browser, self.pipe_out = os.pipe()
        self.pipe_in, from_browser = os.pipe()
        options = f"--headless=new --no-sandbox --disable-gpu --remote-debugging-pipe --user-data-dir={folder} --no-first-run"
        self.process = subprocess.Popen(["sh", "-c", f"exec {program} {options} 3<&{to_browser} 4>&{from_browser}"],
                                        pass_fds=(to_browser, from_browser), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(to_browser)
        os.close(from_browser)
        self.bytes = b""
        self.count = 0
        self.faults = []

    def close(self):
        self.process.terminate()
        self.process.wait()

    def receive(self):
        while b"\0" not in self.bytes:
            if not select.select([self.pipe_in], [], [], PATIENCE_S)[0]:
                raise AssertionError("the browser does not answer")
            part = os.read(self.pipe_in, 1 << 20)
            assert part, "the browser ended"
            self.bytes += part
        message, self.bytes = self.bytes.split(b"\0", 1)
        return json.loads(message)

    def send(self, method, session=None, **parameters):
        self.count += 1
        request = {"id": self.count, "method": method, "params": parameters, **({"sessionId": session} if session else {})}
        data = json.dumps(request).encode() + b"\0"
        while data:
            data = data[os.write(self.pipe_out, data):]
        while True:
            answer = self.receive()
            if answer.get("id") == self.count:
                if "error" in answer:
                    was_left = "navigated" in answer["error"].get("message", "")
                    raise (PageLeft if was_left else AssertionError)(f"{method}: {answer['error']}")
                return answer["result"]
            self.note(answer)

    def note(self, event):
        if event.get("method") == "Runtime.exceptionThrown":
            self.faults.append(event["params"]["exceptionDetails"].get("exception", {}).get("description", "an exception"))
        if event.get("method") == "Log.entryAdded" and event["params"]["entry"]["level"] == "error":
            if not self.is_expected(event["params"]["entry"]):
                self.faults.append(event["params"]["entry"]["text"])


@contextlib.contextmanager
def open_browser(program, **options):
    """A Browser that is closed at the end, whatever happens."""
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        opened = Browser(program, folder, **options)
        try:
            yield opened
        finally:
            opened.close()


class Tab:
    """A page that is open."""

    def __init__(self, browser, url, width, height):
        self.browser = browser
        target = browser.send("Target.createTarget", url="about:blank")["targetId"]
        self.target = target
        self.session = browser.send("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Accessibility"):
            self.do(f"{domain}.enable")
        self.do("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=width < 600)
        # Keys go to what has the focus, whichever window the browser thinks is in front.
        self.do("Emulation.setFocusEmulationEnabled", enabled=True)
        self.go(url)

    def go(self, url):
        """Opens another page."""
        self.do("Page.navigate", url=url)
        self.wait("location.href !== 'about:blank' && document.readyState === 'complete'", "the page")

    def do(self, method, **parameters):
        return self.browser.send(method, self.session, **parameters)

    def close(self):
        self.browser.send("Target.closeTarget", targetId=self.target)

    def js(self, expression):
        result = self.do("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        assert "exceptionDetails" not in result, f"{expression}: {result['exceptionDetails']}"
        return result["result"].get("value")

    def holds(self, expression):
        """False also if the page is left while it is asked."""
        try:
            return self.js(f"Boolean({expression})")
        except PageLeft:
            return False

    def wait(self, expression, why):
        end = time.monotonic() + PATIENCE_S
        while not self.holds(expression):
            if time.monotonic() > end:
                raise AssertionError(f"{why}: {expression}")
            time.sleep(0.05)

    def picture(self, file):
        """Writes what is seen to a PNG file."""
        file.write_bytes(base64.b64decode(self.do("Page.captureScreenshot", format="png")["data"]))

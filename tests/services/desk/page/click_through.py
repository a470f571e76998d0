#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Clicks through the page of the desk in headless Chromium, as wide as a desktop and as a phone.

usage: click_through.py SERVE_PAGE CHROMIUM [PICTURES]

SERVE_PAGE serves a page without a rig (serve_page.cpp). PICTURES: a folder for pictures of what is seen.
"""
import json
import pathlib
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[4] / "scripts"))
from browser import Tab, open_browser

WIDTHS = {"desktop": (1440, 900), "phone": (390, 844)}
NAMED_ROLES = {"button", "slider", "textbox", "searchbox", "combobox", "checkbox", "switch", "radio", "spinbutton", "link"}


def is_refused(entry):
    """What the desk refuses on purpose: a name that is none."""
    return "422" in entry["text"] and entry.get("url", "").endswith("/api/record/start")


class Desk(Tab):
    """The page, used as a person does."""

    def wait(self, expression, why):
        try:
            super().wait(expression, why)
        except AssertionError as error:
            raise AssertionError(f"{error}; the page says '{self.js('document.getElementById(`toast`)?.textContent')}'") from None

    def click(self, selector):
        """As a person does: at the middle of what is seen, once it stands still."""
        place = self.js(f"""(async () => {{ const e = document.querySelector({json.dumps(selector)});
            const frame = () => new Promise((resolve) => setTimeout(resolve, 30));
            e.scrollIntoView({{block: 'center', behavior: 'instant'}});
            let b = e.getBoundingClientRect();
            for (let last = null; !last || last.x !== b.x || last.y !== b.y; b = e.getBoundingClientRect()) {{
              last = b; await frame();
              if (e.getBoundingClientRect().y === b.y) break;
            }}
            const x = b.x + b.width / 2, y = b.y + b.height / 2, top = document.elementFromPoint(x, y);
            return {{x, y, seen: top === e || e.contains(top) || (top && top.contains(e))}}; }})()""")
        assert place["seen"], f"{selector} is covered"
        for kind in ("mousePressed", "mouseReleased"):
            self.do("Input.dispatchMouseEvent", type=kind, x=place["x"], y=place["y"], button="left", clickCount=1)

    def key(self, key, code, number, modifiers=0, text=""):
        for kind in ("keyDown", "keyUp"):
            self.do("Input.dispatchKeyEvent", type=kind, key=key, code=code, windowsVirtualKeyCode=number, modifiers=modifiers,
                    **({"text": text} if text and kind == "keyDown" else {}))

    def type(self, selector, text):
        self.js(f"document.querySelector({json.dumps(selector)}).focus()")
        self.js(f"document.querySelector({json.dumps(selector)}).value = ''")
        self.do("Input.insertText", text=text)

    def part(self, name):
        if self.js("getComputedStyle(document.getElementById('tabs')).display !== 'none'"):
            self.click(f"#tabs a[href='#{name}']")
            self.wait(f"document.getElementById('{name}').classList.contains('shown')", "a tab")

    def keep_picture(self, folder, name):
        if folder:
            self.picture(folder / f"{name}.png")


def check_names(tab, where):
    nodes = tab.do("Accessibility.getFullAXTree")["nodes"]
    for node in nodes:
        role = node.get("role", {}).get("value")
        if role in NAMED_ROLES and not node.get("ignored"):
            assert node.get("name", {}).get("value", "").strip(), f"{where}: a {role} has no name: {node}"


def check_width(tab, width):
    wide = tab.js("document.documentElement.scrollWidth")
    assert wide <= width, f"the page is {wide} px wide on a screen of {width} px"
    if width >= 1000:  # its parts scroll, not the page
        assert tab.js("document.documentElement.scrollHeight <= window.innerHeight"), "the page is higher than the screen"


def check_settings(tab):
    tab.part("settings")
    tab.type("#search", "fill")
    tab.wait("[...document.querySelectorAll('.setting')].filter((e) => e.offsetParent && e.closest('#groups')).length === 1", "the search")
    row = "[...document.querySelectorAll('#groups .setting')].find((e) => e.offsetParent)"
    tab.js(f"{row}.querySelector('input[type=range]').focus()")
    before = tab.js(f"{row}.querySelector('input[type=number]').value")
    tab.key("ArrowRight", "ArrowRight", 39)
    tab.wait(f"{row}.classList.contains('changed')", "a slider by key")
    assert tab.js(f"{row}.querySelector('input[type=number]').value") != before
    tab.wait("document.getElementById('last').textContent.includes('projector.fill.cells')", "who changed what")
    tab.click("#only-changed")
    tab.wait(f"{row}", "the changed one")
    tab.js(f"{row}.querySelector('.reset').setAttribute('data-test', '1')")
    tab.click("[data-test]")
    tab.wait("!document.querySelector('[data-test]').closest('.setting').classList.contains('changed')", "a reset")
    tab.click("#only-changed")
    tab.type("#search", "")
    tab.js("document.getElementById('search').dispatchEvent(new Event('input'))")
    tab.type("#preset-name", "evening")
    tab.click("#preset-store")
    tab.wait("document.getElementById('preset').value === 'evening'", "a preset")
    tab.click("#preset-load")
    tab.wait("document.getElementById('toast').textContent === 'Preset evening'", "a preset that is loaded")


def check_light(tab):
    pressed = "document.getElementById('{}').getAttribute('aria-pressed') === '{}'"
    tab.click("#blackout")
    tab.wait(pressed.format("blackout", "true"), "blackout")
    tab.click("#undo")
    tab.wait(pressed.format("blackout", "false"), "undo")
    tab.js("document.activeElement.blur()")
    tab.key("F", "KeyF", 70, modifiers=8, text="F")
    tab.wait(pressed.format("freeze", "true"), "freeze by key")
    tab.key("F", "KeyF", 70, modifiers=8, text="F")
    tab.wait(pressed.format("freeze", "false"), "freeze by key")
    tab.js("document.getElementById('master').focus()")
    tab.key("ArrowLeft", "ArrowLeft", 37)
    tab.wait("document.getElementById('master-text').textContent === '99 %'", "master by key")
    tab.key("ArrowRight", "ArrowRight", 39)
    tab.wait("document.getElementById('master-text').textContent === '100 %'", "master back by key")
    tab.click("#ab")
    tab.wait("document.getElementById('toast').textContent.startsWith('State B begins')", "compare")
    tab.click("#ab")
    tab.wait("document.getElementById('toast').textContent.startsWith('State A')", "the other state")
    check_compare(tab)


def check_compare(tab):
    """What is turned just before and just after the switch of states belongs to the one that is shown then."""
    shown = "document.getElementById('master-text').textContent === '{} %'"
    time.sleep(1.1)  # the widget follows others again
    tab.js("""(() => { const fader = document.getElementById('master'), ab = document.getElementById('ab');
              const turn = (value) => { fader.value = value; fader.dispatchEvent(new Event('input')); };
              ab.click(); turn(50); ab.click(); turn(80); })()""")
    for percent in (80, 50, 80):  # A, B, A
        tab.wait(shown.format(percent), f"a state with {percent} %")
        time.sleep(1.1)
        assert tab.js(shown.format(percent)), f"{percent} % was taken back"
        tab.js("document.getElementById('ab').click()")
    tab.wait(shown.format(50), "state B")
    tab.js("document.getElementById('ab').click()")
    tab.js("(() => { const fader = document.getElementById('master'); fader.value = 100; fader.dispatchEvent(new Event('input')); })()")
    tab.wait(shown.format(100), "the master as it was")


def check_others(tab):
    tab.part("picture")
    lit = """(() => { const c = document.getElementById('camera'), d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data;
              return c.width > 100 && d.some((v, i) => i % 4 === 0 && v > 100); })()"""
    tab.wait(lit, "a picture")
    tab.wait("/Hz/.test(document.getElementById('picture-text').textContent)", "the rate of the picture")
    tab.part("cues")
    current = "document.querySelector('#cue-list li:nth-child({}) button').getAttribute('aria-current') === 'true'"
    tab.click("#cue-list li:nth-child(3) button")
    tab.wait(current.format(3), "a cue by click")
    tab.click("#cue-go")
    tab.wait(current.format(4), "the next cue")
    tab.click("#cue-back")
    tab.wait(current.format(3), "the cue before")
    assert "8 s, slow at both ends" in tab.js("document.querySelector('#cue-list li:nth-child(3) .does').textContent")
    assert tab.js("document.querySelector('#cue-list li:nth-child(2) .on').textContent") == "key d, no hand for 30 s"
    tab.part("looks")
    if tab.js("document.querySelectorAll('#look-list button').length > 0"):
        tab.wait("document.querySelector('#look-list img').naturalWidth > 0", "the picture of a look")
        tab.click("#look-list button")
        tab.wait("document.getElementById('toast').textContent.includes('on both hands')", "a look")
    tab.part("services")
    tab.wait("document.querySelectorAll('.service').length === 6", "the services")
    tab.wait("/register 9\\d %, hold/.test(document.getElementById('facts').textContent)", "the rungs")
    tab.click("[aria-label='Restart pose']")
    tab.wait("document.getElementById('toast').textContent === 'pose is ready again'", "a restart")


def check_tools(tab):
    tab.part("tools")
    text = "document.getElementById('{}').textContent"
    tab.wait("document.querySelector('#recording-list .name')?.textContent === 'rehearsal'", "a recording")
    assert "42.0 s3.4 MB" in tab.js("document.querySelector('#recording-list div').textContent")
    tab.type("#recording-name", "../outside")
    tab.click("#record-start")
    tab.wait("document.getElementById('toast').textContent.includes('is no name of a recording')", "a name that is none")
    assert tab.js("document.querySelectorAll('#calibration-list li').length") == 4
    tab.click("#doctor-start")
    tab.wait("document.querySelector('#doctor-list .fault strong')?.textContent === 'rig file'", "the doctor, who misses the rig file")
    tab.click("#midi-learn")
    knob = "[aria-label='Learn a MIDI knob for light.master']"
    tab.part("settings")
    tab.click(knob)
    tab.wait(f"document.querySelector(\"{knob}\").textContent.startsWith('controller 7')", "a knob that is bound")
    tab.part("tools")
    tab.click("#midi-learn")
    tab.wait("!document.body.classList.contains('learning')", "the end of learning")
    tab.click("[aria-label='Unbind light.master']")
    tab.wait(f"{text.format('midi-list')}.includes('No knob')", "a knob that is unbound")


def check_leaks(tab):
    """What a page that is left open makes is bounded."""
    def nodes():
        tab.do("HeapProfiler.collectGarbage")
        return tab.browser.send("Memory.getDOMCounters", tab.session)["nodes"]
    before = nodes()
    time.sleep(4)
    after = nodes()
    assert after <= before + 200, f"the page has {after} nodes after {before}"


def check_viewer(browser, url, width, height):
    tab = Desk(browser, url, width, height)
    tab.wait("document.getElementById('link-text').textContent === 'connected as viewer'", "a viewer")
    free = tab.js("""[...document.querySelectorAll('main button, header button, main select, #groups input')]
        .filter((e) => !e.disabled).map((e) => e.id || e.textContent)""")
    assert free == [], f"a viewer may press {free}"
    tab.close()


def click_through(browser, urls, name, folder):
    width, height = WIDTHS[name]
    tab = Desk(browser, urls["owner"], width, height)
    tab.wait("document.getElementById('link-text').textContent === 'connected as owner'", "the start")
    assert "token" not in tab.js("location.href"), "the token is still in the address"
    check_light(tab)
    check_settings(tab)
    tab.keep_picture(folder, f"{name}-settings")
    check_others(tab)
    check_tools(tab)
    for part in ("picture", "looks", "cues", "services", "tools"):
        tab.part(part)
        tab.js(f"document.getElementById('{part}').scrollIntoView()")
        time.sleep(0.6)
        check_width(tab, width)
        check_names(tab, part)
        tab.keep_picture(folder, f"{name}-{part}")
    check_leaks(tab)
    tab.close()
    check_viewer(browser, urls["viewer"], width, height)


def main():
    serve_page, chromium = sys.argv[1:3]
    folder = pathlib.Path(sys.argv[3]) if len(sys.argv) > 3 else None
    server = subprocess.Popen([serve_page], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    urls = {role: server.stdout.readline().strip() for role in ("viewer", "operator", "owner")}
    try:
        with open_browser(chromium, is_expected=is_refused) as browser:
            for name in WIDTHS:
                click_through(browser, urls, name, folder)
            assert not browser.faults, f"the browser complains: {browser.faults}"
    finally:
        server.stdin.close()
        server.wait()
    print("clicked through at", ", ".join(f"{width}x{height}" for width, height in WIDTHS.values()))


if __name__ == "__main__":
    main()

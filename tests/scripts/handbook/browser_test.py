# SPDX-License-Identifier: Apache-2.0
"""The handbook in a browser, opened from the disk: its search finds, and it fits a phone, a desktop and paper."""
import shutil
import unittest

from made_handbook import Made

from browser import Tab, open_browser

CHROMIUM = shutil.which("chromium")
# Where the search leads first, and what the browser says of the page.
FIRST = "document.querySelector('#found a')?.getAttribute('href')"


@unittest.skipUnless(CHROMIUM, "chromium is not installed")
class InABrowser(Made):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.browser = cls.enterClassContext(open_browser(CHROMIUM))

    def open(self, page, width=1280):
        tab = Tab(self.browser, (self.folder / page).as_uri(), width, 844)
        self.addCleanup(tab.close)
        return tab

    def search(self, tab, words):
        tab.js("document.getElementById('search').value = ''; document.getElementById('search').focus()")
        tab.do("Input.insertText", text=words)
        tab.wait("!document.getElementById('found').hidden", "an answer")

    def test_the_search_finds_a_section_from_every_folder(self):
        for page, root in (("index.html", ""), ("docs/tour.html", "../"), ("docs/operating/desk.html", "../../")):
            tab = self.open(page)
            self.search(tab, "Tracker moved")
            self.assertEqual(tab.js(FIRST), root + "docs/operating/technician.html#when-the-tracker-has-moved")

    def test_the_search_finds_a_setting_and_leads_there(self):
        tab = self.open("index.html")
        self.search(tab, "delivery_ms")
        self.assertIn("config/REFERENCE.html#camera", tab.js("[...document.querySelectorAll('#found a')].map((a) => a.getAttribute('href'))"))
        tab.js("document.querySelector('#found a').click()")
        tab.wait("document.querySelector('main h1') && location.pathname !== '/index.html'", "the page")

    def test_the_search_says_that_it_finds_nothing(self):
        tab = self.open("index.html")
        self.search(tab, "qwertzuiop")
        tab.wait("document.getElementById('found').textContent.includes('Nothing')", "an answer")

    def test_no_page_is_wider_than_a_phone(self):
        tab = self.open("index.html", width=390)
        for page in sorted(self.folder.rglob("*.html")):
            tab.go(page.as_uri())
            self.assertLessEqual(tab.js("document.documentElement.scrollWidth"), 390, page)

    def test_a_page_is_dark_where_people_want_that(self):
        tab = self.open("docs/tour.html")
        grey = "Number(getComputedStyle(document.body).backgroundColor.match(/\\d+/)[0])"
        for scheme, is_dark in (("light", False), ("dark", True)):
            tab.do("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": scheme}])
            self.assertEqual(tab.js(grey) < 128, is_dark, scheme)

    def test_paper_has_the_text_alone(self):
        tab = self.open("docs/operating/desk.html")
        tab.do("Emulation.setEmulatedMedia", media="print")
        shown = "[...document.querySelectorAll('.top, nav, details.contents, main footer')].filter((e) => e.offsetParent).length"
        self.assertEqual(tab.js(shown), 0)
        self.assertGreater(tab.js("document.querySelector('main').offsetWidth"), 900)

    def test_no_page_makes_the_browser_complain(self):
        tab = self.open("index.html")
        self.search(tab, "light")
        self.assertEqual(self.browser.faults, [])


if __name__ == "__main__":
    unittest.main()

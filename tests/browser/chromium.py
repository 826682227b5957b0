"""A headless Chromium for tests that look at pages: skipped with a word where there is none, but not in CI."""

import os
import shutil
from contextlib import contextmanager

import pytest

ARGUMENTS = (
    *("--no-sandbox", "--disable-gpu", "--disable-background-networking", "--disable-component-update"),
    *("--disable-sync", "--no-first-run"),
)


def executable():
    """Where Chromium is. Without one the test is skipped, or fails where the environment says CI."""
    found = shutil.which("chromium") or shutil.which("chromium-browser")
    if found:
        return found
    word = "no Chromium found: apt-get install chromium"
    if os.environ.get("CI"):
        pytest.fail(word)
    pytest.skip(word)


@contextmanager
def browser():
    """A running browser, closed at the end."""
    where = executable()
    playwright = (
        pytest.importorskip("playwright.sync_api")
        if not os.environ.get("CI")
        else __import__("playwright.sync_api").sync_api
    )
    with playwright.sync_playwright() as running:
        chromium = running.chromium.launch(executable_path=where, args=list(ARGUMENTS))
        try:
            yield chromium
        finally:
            chromium.close()


class Watched:
    """A page with everything it asked for and complained about."""

    def __init__(self, chromium, path, width=1280):
        self.page = chromium.new_page(viewport={"width": width, "height": 900})
        self.requests, self.complaints = [], []
        self.page.on("request", lambda request: self.requests.append(request.url))
        self.page.on("console", self._heard)
        self.page.on("pageerror", lambda error: self.complaints.append(str(error)))
        self.page.goto(path.as_uri())
        self.page.wait_for_selector("html[data-drawn]")

    def _heard(self, said):
        """Errors and warnings; not that a picture of WebGL is slow to read, which only a browser without a GPU says."""
        if said.type in ("error", "warning") and "GPU stall due to ReadPixels" not in said.text:
            self.complaints.append(said.text)

    def __call__(self, script):
        return self.page.evaluate(script)

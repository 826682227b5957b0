"""axe-core in a page: what a blind, colour-blind or mouseless reader would stumble over.

A tool of the tests alone (MPL-2.0): ``npm ci`` in opsim/viewer/page gets it, nothing of it is shipped.
"""

import os
from functools import cache
from pathlib import Path

import pytest

SCRIPT = Path(__file__).parents[2] / "opsim" / "viewer" / "page" / "node_modules" / "axe-core" / "axe.min.js"
STUMBLES = ("serious", "critical")
RUN = "async () => (await axe.run(document, {resultTypes: ['violations']})).violations"


@cache
def script():
    """The text of axe-core. Without it the test is skipped, or fails where the environment says CI."""
    if not SCRIPT.exists():
        (pytest.fail if os.environ.get("CI") else pytest.skip)("no axe-core found: make page-packages")
    return SCRIPT.read_text(encoding="utf-8")


def serious(page):
    """Serious and critical faults of a playwright page as it stands, a line for each thing that has one."""
    page.evaluate(script())
    return [
        f"{fault['impact']} {fault['id']}: {thing['html'][:160]} ({thing['failureSummary'].splitlines()[-1].strip()})"
        for fault in page.evaluate(RUN)
        if fault["impact"] in STUMBLES
        for thing in fault["nodes"]
    ]

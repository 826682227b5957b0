"""Worked cases beside the project; where they are not at hand, tests are skipped."""

import json
from pathlib import Path

import pytest

WHERE = Path(__file__).parents[3].parent / "shared" / "data" / "reference"


def reference(name):
    """What a file of worked cases holds."""
    path = WHERE / name
    if not path.exists():
        pytest.skip(f"{name} is not at hand: expected at ../shared/data/reference/{name}")
    return json.loads(path.read_text(encoding="utf-8"))

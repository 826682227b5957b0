"""``engine.json`` in a study's folder: which engine was asked for and used, and why. No file: SimPy alone was."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from opsim.engine.choice import SIMPY, Choice, Told
from opsim.study.engine_choice import Chosen
from opsim.whole import write_json

ENGINE = "engine.json"


class EnginesFile:
    """Is told of every engine before it answers anything, writes it down, and tells others of it."""

    def __init__(self, folder: Path, has_answers: bool, then: Chosen | None = None):
        """has_answers : whether answers are there already, by engines that the file names"""
        self._path, self._then = folder / ENGINE, then
        self._used: dict[str, str] = {}
        held = _read(self._path)
        before = {*held.get("used", ()), *held.get("earlier", ())} or {SIMPY}
        self._before: set[str] = before if has_answers else set()

    def __call__(self, choice: Choice) -> Told | None:
        """Raises OSError where it cannot be written."""
        self._used[choice.engine] = choice.why
        earlier = sorted(self._before - {*self._used})
        if earlier or self._path.exists() or choice.asked != SIMPY:
            said = {"asked": choice.asked, "used": self._used}
            write_json(self._path, said | ({"earlier": earlier} if earlier else {}))
        return None if self._then is None else self._then(choice)


def _read(path: Path) -> dict[str, Any]:
    try:
        held = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}
    return held if isinstance(held, dict) else {}

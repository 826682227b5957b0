"""``engine.json`` in a study's folder: which engine was asked for and used, and why. No file: SimPy alone was.

A shard has a file of its own beside it, as it has a journal.
"""

from __future__ import annotations

import json
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from opsim.engine.choice import REFERENCE, SIMPY, Choice, Told
from opsim.study.engine_choice import Chosen
from opsim.study.jobs.shard import Shard
from opsim.whole import write_json

ENGINE = "engine.json"


class EnginesFile:
    """Is told of every engine before it answers anything, writes it down, and tells others of it."""

    def __init__(self, own: Path, journals: Iterable[Path], then: Chosen | None = None):
        """own : the journal that is written to; journals : those that are gone on with"""
        self._path, self._then = file_of(own), then
        self._used: dict[str, str] = {}
        self._before = {engine for held in _held(journals) for engine in (*held["used"], *held["earlier"])}

    def __call__(self, choice: Choice) -> Told | None:
        """Raises OSError where it cannot be written."""
        self._used[choice.engine] = choice.why
        if self._before - {SIMPY} or self._path.exists() or choice.asked != SIMPY:
            _write(self._path, choice.asked, self._used, self._before)
        return None if self._then is None else self._then(choice)


def file_of(journal: Path) -> Path:
    """The file of a journal of a study's folder: a file each, so that shards in one folder do not write to the same."""
    name = ENGINE if Shard.of_file(journal.name) is None else f"engine_{journal.stem}.json"
    return journal.parents[1] / name


def files_in(folder: Path) -> list[Path]:
    """All that there are."""
    return sorted(folder.glob("engine*.json"))


def write_together(journals: Iterable[Path], folder: Path) -> None:
    """Write into a folder which engines have answered anything of some journals. Raises OSError."""
    held = _held(journals)
    used = {engine: why for one in reversed(held) for engine, why in sorted(one["used"].items())}
    earlier = {engine for one in held for engine in one["earlier"]}
    if {*used} | earlier != {SIMPY} or (folder / ENGINE).exists():
        asked = {word for one in held for word in one["asked"].split(", ")}
        _write(folder / ENGINE, ", ".join(sorted(asked)), used, earlier)


def _write(path: Path, asked: str, used: dict[str, str], before: set[str]) -> None:
    earlier = sorted(before - {*used})
    write_json(path, {"asked": asked, "used": used} | ({"earlier": earlier} if earlier else {}))


def _held(journals: Iterable[Path]) -> list[dict[str, Any]]:
    """What is said of each journal that holds anything."""
    return [_read(file_of(journal)) for journal in journals if journal.stat().st_size]


def _read(path: Path) -> dict[str, Any]:
    known = {"asked": SIMPY, "used": {SIMPY: REFERENCE.why}, "earlier": []}
    try:
        held = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return known
    return {"asked": SIMPY, "used": {}, "earlier": []} | held if isinstance(held, dict) else known

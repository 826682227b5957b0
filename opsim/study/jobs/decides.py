"""What decides the answers of a point: its answers are found again only where all of it is the same."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator
from functools import lru_cache
from pathlib import Path
from typing import Any

from opsim.study.jobs.evaluate import loaded_of
from opsim.study.jobs.job import Point
from opsim.study.jobs.source import Source
from opsim.study.manifest import deciding, manifest_of
from opsim.study.resolved import decides_figures

ASKED_ONLY = ("outputs", "frontier")
"""What decides neither rows nor figures of a scenario, only which figures stand in front."""


def made_from(source: Source, variant: str | None) -> dict[str, Any]:
    """Everything that decides the answers of a variant without a point's changes, and the versions that make them.

    Raises ScenarioError, OSError.
    """
    held: dict[str, Any] = json.loads(_made_from(source.file, source.seed, variant, _text(source.changes)))
    return held


def decided_by(source: Source, point: Point) -> str:
    """16 hex digits that tell the answers of a point from those of any other: by its variant, changes, the seed, the
    contents of all files, and versions. Raises as ``made_from``.
    """
    variant = deciding(made_from(source, point.variant))
    files = _files_named(source, point)
    return hashlib.blake2b(_text([variant, point.key, files]).encode(), digest_size=8).hexdigest()


@lru_cache(256)
def _made_from(file: str, seed: int | None, variant: str | None, changes: str) -> str:
    source = Source(file, (), seed, json.loads(changes))
    loaded = loaded_of(source, Point(variant or "", {}, variant))
    manifest = manifest_of(loaded, loaded.scenario.run.seed if seed is None else seed)
    figures = {path: value for path, value in decides_figures(loaded.resolved).items() if path not in ASKED_ONLY}
    return _text({**manifest, "figures_sha256": hashlib.sha256(_text(figures).encode()).hexdigest()})


def _files_named(source: Source, point: Point) -> dict[str, str]:
    """The contents of files that changes name, such as another library: the variant's own are in its manifest."""
    named = {text for text in _texts([dict(source.changes), dict(point.changes)]) if len(text) < 256}
    if not named:
        return {}
    folder = _folder(source.file)
    return {name: _sha256(folder / name) for name in sorted(named) if "." in name and (folder / name).is_file()}


@lru_cache(4)
def _folder(file: str) -> Path:
    from opsim.shipped import find_scenario

    return find_scenario(file).parent


@lru_cache(256)
def _sha256(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()


def _texts(value: Any) -> Iterator[str]:
    if isinstance(value, str):
        yield value
    elif isinstance(value, dict):
        for below in value.values():
            yield from _texts(below)
    elif isinstance(value, list | tuple):
        for below in value:
            yield from _texts(below)


def _text(value: Any) -> str:
    return json.dumps(value, sort_keys=True, default=dict)

"""``study.json``: what was asked of a study and what its answers are made from; two of them compared in words.

``engine.json`` in a study's folder: which engine was asked for and used, and why. No file: SimPy alone was.

A shard has a file of its own beside it, as it has a journal.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from opsim.engine import SIMPY
from opsim.engine.choice import REFERENCE, Choice, Told
from opsim.files import write_json
from opsim.study.engine_choice import Chosen
from opsim.study.jobs.evaluate import made_from
from opsim.study.jobs.job import Shard, Source
from opsim.study.results_folder import deciding

HEADER = "study.json"
FORMAT = 1


class NotAStudy(ValueError):
    """A file that is not the header of a study of this opsim."""


@dataclass(frozen=True)
class Header:
    """kind : of the study. asked : its block, as plain values. words : the command that asked for it

    variant      : the variant to start from, by name. made_from : what decides its answers
    replications : of each point, where the study leaves that to its user
    """

    kind: str
    source: Source
    variant: str
    asked: Mapping[str, Any]
    made_from: Mapping[str, Any]
    replications: int | None = None
    words: Sequence[str] = field(default=())

    @property
    def command(self) -> str:
        """What to type for this study, without where and how it is computed."""
        import shlex

        return shlex.join(["opsim", *(self.words or (self.kind, self.source.file))])

    def plain(self) -> dict[str, Any]:
        """As it stands in the file."""
        return {
            "opsim_study": FORMAT,
            "kind": self.kind,
            "file": self.source.file,
            "variant": self.variant,
            "seed": self.source.seed,
            "replications": self.replications,
            "changes": dict(self.source.changes),
            "figures": list(self.source.kpis),
            "asked": dict(self.asked),
            "command": list(self.words),
            "made_from": dict(self.made_from),
        }


def header_of(
    kind: str,
    source: Source,
    variant: str,
    asked: Mapping[str, Any],
    replications: int | None = None,
    words: Sequence[str] = (),
) -> Header:
    """The header of a study that is about to begin. Raises ScenarioError, OSError."""
    return Header(kind, source, variant, asked, made_from(source, variant), replications, words)


def write_header(header: Header, folder: Path) -> None:
    """Write it whole. Raises OSError."""
    write_json(folder / HEADER, header.plain())


def read_header(folder: Path) -> Header:
    """The header of a study's folder. Raises OSError, NotAStudy."""
    path = folder / HEADER
    try:
        said = json.loads(path.read_text(encoding="utf-8"))
        if said["opsim_study"] != FORMAT:
            raise NotAStudy(f"{path}: a study of another opsim")
        source = Source(said["file"], tuple(said["figures"]), said["seed"], said["changes"])
        more = said["replications"], tuple(said["command"])
        return Header(said["kind"], source, said["variant"], said["asked"], said["made_from"], *more)
    except (KeyError, TypeError, ValueError) as error:
        if isinstance(error, NotAStudy):
            raise
        raise NotAStudy(f"{path}: not the header of a study that this opsim can read") from None


def differing(held: Header, now: Header) -> list[str]:
    """In words, in what two studies differ such that answers of one are not answers of the other."""
    words = []
    if held.kind != now.kind:
        words.append(f"a {held.kind} study, now {now.kind}")
    if held.variant != now.variant:
        words.append(f"begins with variant {held.variant}, now {now.variant}")
    words += made_differ(held.made_from, now.made_from)
    if held.kind == now.kind and not set(now.source.kpis) <= set(held.source.kpis):
        missing = [kpi for kpi in now.source.kpis if kpi not in held.source.kpis]
        words.append(f"{', '.join(missing)} was not kept of its replications")
    return words


def made_differ(held: Mapping[str, Any], now: Mapping[str, Any]) -> list[str]:
    """In words, in what the sources of two studies' answers differ."""
    if deciding(dict(held)) == deciding(dict(now)):
        return []
    words = []
    if held.get("seed") != now.get("seed"):
        words.append(f"seed {held.get('seed')}, now {now.get('seed')}")
    if any(held.get(name) != now.get(name) for name in ("resolved_sha256", "figures_sha256")):
        other = held.get("scenario") != now.get("scenario")
        words.append(f"scenario {held.get('scenario')!r}, now {now.get('scenario')!r}" if other else "the scenario")
    for kind, what in (("libraries", "library"), ("recorded", "file"), ("plugins", "plug-in")):
        old, new = held.get(kind) or {}, now.get(kind) or {}
        words += [f"{what} {name} has changed" for name in {**old, **new} if old.get(name) != new.get(name)]
    old, new = _versions(held), _versions(now)
    words += [
        f"{name} {old.get(name)}, now {new.get(name)}" for name in {**old, **new} if old.get(name) != new.get(name)
    ]
    return words or ["what its answers are made from"]


def _versions(made: Mapping[str, Any]) -> dict[str, Any]:
    return {"opsim": made.get("opsim"), "python": made.get("python"), **made.get("packages", {})}


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

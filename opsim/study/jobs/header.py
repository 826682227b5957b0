"""``study.json``: what was asked of a study and what its answers are made from; two of them compared in words."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from opsim.study.jobs.decides import made_from
from opsim.study.jobs.source import Source
from opsim.study.manifest import deciding
from opsim.whole import write_json

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

"""What is asked of a study: one replication of one point.

What the replications of a study are made from: small enough to be sent to any process.

What one replication says, small enough to be sent from one machine to another.

One part of a study's jobs, for machines that know nothing of each other.
"""

from __future__ import annotations

import json
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from hashlib import blake2b
from typing import Any, TypeVar

from opsim.kpi.catalogue import Figure
from opsim.results import Key


@dataclass(frozen=True)
class Point:
    """A scenario of a study: a variant of its file with changes (dotted path -> plain YAML value) laid over it.

    name : for people; two points with the same variant and changes are the same point, whatever they are called
    """

    name: str
    changes: Mapping[str, Any]
    variant: str | None = None

    @cached_property
    def key(self) -> str:
        """16 hex digits that tell the variant and its changes from others."""
        said = json.dumps([self.variant, sorted(self.changes.items())], sort_keys=True)
        return blake2b(said.encode(), digest_size=8).hexdigest()

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Point) and self.key == other.key

    def __hash__(self) -> int:
        return hash(self.key)


@dataclass(frozen=True, slots=True)
class Job:
    """One replication of one point; ``workforce`` keys who the people are (None: as the scenario's staffing says)."""

    point: Point
    replication: int
    workforce: int | None = None

    @property
    def key(self) -> tuple[str, int, int]:
        """By which its answer is found again; a workforce of -1 is none."""
        return self.point.key, self.replication, -1 if self.workforce is None else self.workforce


@dataclass(frozen=True)
class Source:
    """A scenario file and what all points of a study share.

    file    : the scenario file, or the name of a shipped one; every process that computes must be able to read it
    seed    : instead of the scenario's own
    kpis    : names of the figures that are kept of each replication, with all their subjects and parts
    changes : dotted paths and plain YAML values laid over every point, such as {"run.horizon": "4 h"}
    """

    file: str
    kpis: tuple[str, ...]
    seed: int | None = None
    changes: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Answer:
    """``figures`` is the JSON text of the figures' keys, ``values`` the numbers in their order."""

    figures: str
    values: tuple[float, ...]

    @classmethod
    def of(cls, figures: Sequence[Figure]) -> Answer:
        """An answer from figures, in one order whatever theirs is."""
        figures = sorted(figures, key=lambda figure: figure[:4])
        keys = json.dumps([list(figure[:4]) for figure in figures], ensure_ascii=False)
        return cls(keys, tuple(float(figure.value) for figure in figures))


def keys_in(figures: str) -> list[Key]:
    """(kpi, subject, part, unit) of each value of an answer."""
    return [(kpi, subject, part, unit) for kpi, subject, part, unit in json.loads(figures)]


T = TypeVar("T")
MOST_SHARDS = 100_000


@dataclass(frozen=True, order=True)
class Shard:
    """Every ``of``-th job of a study, beginning with the ``number``-th, which counts from 1."""

    number: int
    of: int

    @classmethod
    def read(cls, text: str) -> Shard:
        """``2/8`` -> the second of eight. Raises ValueError."""
        found = re.fullmatch(r"\s*(\d{1,6})\s*/\s*(\d{1,6})\s*", text)
        if not found:
            raise ValueError(f"--shard: expected which of how many, such as 2/8, found {text[:40]!r}")
        number, of = map(int, found.groups())
        if not 1 <= of <= MOST_SHARDS:
            raise ValueError(
                f"--shard {text.strip()}: the second number says how many parts there are, from 1 to {MOST_SHARDS:,}"
            )
        if not 1 <= number <= of:
            which = f"from 1 to {of}" if of > 1 else "1"
            raise ValueError(f"--shard {text.strip()}: the first number must be {which}, as in 1/{of}")
        return cls(number, of)

    @classmethod
    def of_file(cls, name: str) -> Shard | None:
        """The shard whose journal a file is; None for that of a whole study."""
        found = re.fullmatch(r"shard_(\d+)_of_(\d+)\.jsonl", name)
        return cls(int(found[1]), int(found[2])) if found else None

    @property
    def file(self) -> str:
        """The name of its journal."""
        return f"shard_{self.number}_of_{self.of}.jsonl"

    def __str__(self) -> str:
        return f"{self.number}/{self.of}"

    def takes(self, jobs: Sequence[T]) -> Sequence[T]:
        """Its part of all jobs."""
        return jobs[self.number - 1 :: self.of]


class ShardDone(Exception):
    """A shard's part of a study is computed; nothing more is to be had of it. ``left``: jobs not there of all."""

    def __init__(self, mine: int, of: int, left: int):
        super().__init__(mine, of, left)
        self.mine, self.of, self.left = mine, of, left


class Missing(Exception):
    """Answers that are not there where nothing may be computed: ``places`` of them in a list of ``of`` jobs."""

    def __init__(self, places: Sequence[int], of: int):
        super().__init__(tuple(places), of)
        self.places, self.of = tuple(places), of

"""One part of a study's jobs, for machines that know nothing of each other."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeVar

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

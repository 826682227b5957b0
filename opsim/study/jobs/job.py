"""What is asked of a study: one replication of one point."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from hashlib import blake2b
from typing import Any


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

"""What a study of which is best found, and which replications it looked at."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from opsim.results import Key
from opsim.study.interval import Interval
from opsim.study.select.asking import Limit
from opsim.study.select.search import Trial
from opsim.study.select.selection import Selection


@dataclass(frozen=True, slots=True)
class Fresh:
    """The chosen one on replications that had no part in choosing it, beside the base with the same luck.

    first, n    : replications first, ..., first + n - 1
    chosen, base : of the figure, then of each limit
    difference  : chosen minus base, of pairs; None where the base is the chosen one
    """

    first: int
    n: int
    chosen: tuple[Interval, ...]
    base: tuple[Interval, ...]
    difference: Interval | None
    p: float = float("nan")


@dataclass(frozen=True, slots=True)
class Searched:
    """What a search tried. finalists : names of the points that went on -> which trial, from 0."""

    trials: tuple[Trial, ...]
    replications: int
    finalists: Mapping[str, int]


@dataclass(frozen=True)
class Found:
    """key : the figure; keys : those of limits. indifference_said : as it was written

    changes   : of each candidate, by name; called: of those that a search found, in words
    factors   : what is varied, short name -> dotted path
    first     : number of the first replication of the choice; apart : whether each candidate has numbers of its own
    selection : None where a search left only one
    """

    key: Key
    better: str
    keys: tuple[Key, ...]
    limits: tuple[Limit, ...]
    indifference: float
    indifference_said: str
    confidence: float
    procedure: str
    base: str
    changes: Mapping[str, Mapping[str, Any]]
    first: int
    apart: bool
    selection: Selection | None
    winner: str
    most: int
    fresh: Fresh | None = None
    searched: Searched | None = None
    called: Mapping[str, str] = field(default_factory=dict)
    factors: Mapping[str, str] = field(default_factory=dict)

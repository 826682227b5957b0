"""What a report is made from: the figures of a run, and the rows of one replication with the plan they came from.

The very same thing as a key of what is worked out once, though it could not be one by its value.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

from opsim.problems import natural_key
from opsim.study.run import Reopened


@dataclass(frozen=True)
class Material:
    """One variant, and what stands beside it.

    siblings : the Results of all variants of the run by name, in their order, this one among them
    pictures : of movements drawn so far, by (library, task of it); added to, so that variants share them
    """

    run: Reopened
    siblings: Mapping[str, Any] = field(default_factory=dict)
    pictures: dict[tuple[str, str], bytes] = field(default_factory=dict)

    @property
    def result(self) -> Any:
        return self.run.result

    @property
    def summary(self) -> dict[str, Any]:
        return dict(self.run.result.summary)

    @property
    def manifest(self) -> dict[str, Any]:
        return self.run.manifest

    @property
    def loaded(self) -> Any:
        return self.run.loaded

    @property
    def plan(self) -> Any:
        return self.run.plan

    @cached_property
    def log(self) -> Any:
        """The rows of the first replication, read once; None where no rows are kept."""
        return self.run.log() if self.result.events_files else None

    def rows(self, kpi: str) -> list[dict[str, Any]]:
        """What the summary says of one figure, a row a subject and part."""
        return [row for row in self.result.summary["kpis"] if row["kpi"] == kpi]


def materials(runs: Mapping[str, Reopened], results: Mapping[str, Any]) -> Iterable[tuple[str, Material]]:
    """A material a run, one after the other, so that the rows of one alone are held.

    results : of all variants of the run, those of other runs in the folder too: only its own stand beside one
    """
    pictures: dict[tuple[str, str], bytes] = {}
    beside = {name: results[name] for name in in_order(results)}
    for name, run in runs.items():
        yield name, Material(run, beside, pictures)


def in_order(names: Iterable[str]) -> list[str]:
    """What is called base first, then in natural order: one order, whoever writes the report."""
    return sorted(names, key=lambda name: (name != "base", natural_key(name)))


@dataclass(frozen=True, slots=True, eq=False)
class Same:
    """Equal where it holds the very same: reports of all variants of a run share their siblings, tasks their models."""

    of: Any

    def __hash__(self) -> int:
        return id(self.of)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Same) and other.of is self.of

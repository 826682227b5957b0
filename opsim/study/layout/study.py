"""The layout study: flows of today, proposals, all simulated, the one to take, looked at again on fresh luck."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from opsim.kpi.better import MORE, Asked, read_asked
from opsim.kpi.values import SECONDS_PER_HOUR
from opsim.layout import Ways, ways
from opsim.scenario.varied import Varied
from opsim.study.jobs import Answers, Job, Point
from opsim.study.layout.choose import chosen, gains, losses
from opsim.study.layout.floor import Floor, Movable, NoLayout, floor_of, movable
from opsim.study.layout.flows import Flows, flows_of
from opsim.study.layout.judge import Against, against, exposure_asked, measures
from opsim.study.layout.moves import Candidate, clash, what_ifs
from opsim.study.layout.proposals import Proposals, proposals

FEWEST = 10
"""Replications of each layout, where nobody says how many."""
NOW = "now"
ALWAYS_KEPT = ("throughput_per_h", "walked_m", "worker_states", "trips_per_h")


@dataclass(frozen=True)
class LayoutAsked:
    """What is asked: of which floor, by which block of ``studies: layout``."""

    floor: Floor
    block: Any
    variant: str | None
    seed: int

    @property
    def replications(self) -> int:
        """Of each layout, and as many fresh ones at the end."""
        return self.block.replications or max(FEWEST, self.floor.scenario.run.replications)

    @property
    def best(self) -> Asked:
        return read_asked(self.block.best)

    @property
    def exposure(self) -> Asked | None:
        return exposure_asked(self.floor.scenario.outputs, self.block.exposure)

    @property
    def hours(self) -> float:
        """Of the window."""
        run = self.floor.scenario.run
        return (run.horizon_s - run.warm_up_s) / SECONDS_PER_HOUR

    @property
    def kept(self) -> tuple[str, ...]:
        """Names of the figures that the study needs of each replication."""
        exposure = () if self.exposure is None else (self.exposure.kpi,)
        return tuple(dict.fromkeys((*ALWAYS_KEPT, self.best.kpi, *exposure)))

    @cached_property
    def what_ifs(self) -> list[Candidate]:
        """Raises NoLayout with everything that is wrong with any of them."""
        return what_ifs(self.floor, self.block)

    @cached_property
    def clash(self) -> str:
        """Why the changes asked for are not simulated all together too; "" where they are."""
        return clash(self.floor, self.block)

    @cached_property
    def free(self) -> Movable | None:
        """What proposals may move; None where none are asked for. Raises NoLayout."""
        return movable(self.floor, self.block.fixed, self.block.places) if self.block.proposals else None

    def check(self) -> None:
        """Raise NoLayout with everything that can be known to be wrong before a run."""
        wrong: list[str] = []
        for look in (lambda: self.what_ifs, lambda: self.free, self._check_anything):
            try:
                look()
            except NoLayout as error:
                wrong.append(str(error))
        if wrong:
            raise NoLayout("\n".join(wrong))

    def _check_anything(self) -> None:
        scenario = self.floor.scenario
        if not scenario.workers and scenario.workforce is None:
            raise NoLayout("nobody works here, so nobody walks: another layout would gain nothing")
        exposure = self.exposure
        if exposure is not None and exposure.better == MORE:
            raise NoLayout(
                f"exposure: of {exposure.name} more is better; name what bodies go through, such as "
                "rula_from_5_min_per_h"
            )
        if not self.block.proposals and not self.what_ifs:
            raise NoLayout("no proposals and no change are asked for; say --proposals 5, or e.g. --swap saw,drill")


@dataclass(frozen=True)
class LayoutFound:
    """What came out.

    flows, flows_then : of the present layout and of the one taken; compared : by layout and measure, all on the same
    replications; taken : None where the present layout is to be kept; alike : names of the layouts that are not told
    from the best one, ``NOW`` is the present one; fresh : the one taken against the present one, on fresh replications
    """

    asked: LayoutAsked
    flows: Flows
    proposals: Proposals | None
    candidates: tuple[Candidate, ...]
    now: Mapping[str, np.ndarray]
    compared: Mapping[str, Mapping[str, Against]]
    taken: Candidate | None
    alike: tuple[str, ...]
    fresh: Mapping[str, Against]
    flows_then: Flows | None

    @property
    def gains(self) -> list[str]:
        """Measures by which the layout taken is clearly better on fresh replications; none: leave it as it is."""
        return gains(self.fresh, self.asked.best) if self.fresh else []

    @property
    def losses(self) -> list[str]:
        """Measures by which it is clearly worse there."""
        return losses(self.fresh, self.asked.best) if self.fresh else []


def asked_of(varied: Varied, loaded: Any, block: Any, variant: str | None, seed: int | None = None) -> LayoutAsked:
    """varied : the variant with its tree; loaded : the same, read. seed : instead of its own"""
    from opsim.scenario.positions import entries, text

    own = {name: text(node, "at") is not None for name, node in entries(varied.tree, "stations").items()}
    return LayoutAsked(floor_of(loaded, own), block, variant, loaded.scenario.run.seed if seed is None else seed)


def study_layout(asked: LayoutAsked, answers: Answers) -> LayoutFound:
    """A pure function of what is asked and the answers to its jobs.

    Raises NoLayout where it makes no sense, ScenarioError where a layout cannot be simulated.
    """
    asked.check()
    numbers = range(asked.replications)
    base = Point(NOW, {}, asked.variant)
    named = asked.what_ifs
    answers.check([base, *(_point(asked, one) for one in named)])
    answers.ensure([job for point in (base, *(_point(asked, one) for one in named)) for job in _jobs(point, numbers)])
    flows = flows_of(answers, _jobs(base, numbers), asked.floor.ways)
    if not flows.walked.any():
        raise NoLayout(f"nobody walks in {asked.replications} replications: another layout would gain nothing")
    made = None if asked.free is None else proposals(asked.floor, asked.free, flows, asked.block.proposals, asked.seed)
    candidates = (*_new(made, named), *named)
    if not candidates:
        return LayoutFound(asked, flows, made, (), _measured(asked, answers, base, numbers), {}, None, (NOW,), {}, None)
    answers.ensure([job for one in candidates for job in _jobs(_point(asked, one), numbers)])
    values = {one.name: _measured(asked, answers, _point(asked, one), numbers) for one in candidates}
    now = _measured(asked, answers, base, numbers)
    name, alike = chosen({NOW: now, **values}, asked.best, NOW)
    taken = next((one for one in candidates if one.name == name), None)
    fresh, then = _again(asked, answers, base, taken)
    compared = against(values, now)
    return LayoutFound(asked, flows, made, candidates, now, compared, taken, tuple(alike), fresh, then)


def ways_then(asked: LayoutAsked, one: Candidate) -> Ways:
    """The ways where a candidate's places are."""
    layout = asked.floor.scenario.layout
    return ways(layout.model_copy(update={"places": {**layout.places, **one.moved}})) if one.moved else asked.floor.ways


def _again(
    asked: LayoutAsked, answers: Answers, base: Point, taken: Candidate | None
) -> tuple[dict[str, Against], Flows | None]:
    """The layout taken against the present one, on replications that had no part in taking it; and its flows there."""
    if taken is None:
        return {}, None
    numbers, point = range(asked.replications, 2 * asked.replications), _point(asked, taken)
    answers.ensure([*_jobs(base, numbers), *_jobs(point, numbers)])
    of = {taken.name: _measured(asked, answers, point, numbers)}
    fresh = against(of, _measured(asked, answers, base, numbers))[taken.name]
    return fresh, flows_of(answers, _jobs(point, numbers), ways_then(asked, taken))


def _new(made: Proposals | None, named: Sequence[Candidate]) -> list[Candidate]:
    """Proposals that are not what somebody asked for by name."""
    asked = [dict(one.changes) for one in named]
    return [] if made is None else [one for one in made.candidates if dict(one.changes) not in asked]


def _point(asked: LayoutAsked, one: Candidate) -> Point:
    return Point(one.name, one.changes, asked.variant)


def _jobs(point: Point, numbers: range) -> list[Job]:
    return [Job(point, number) for number in numbers]


def _measured(asked: LayoutAsked, answers: Answers, point: Point, numbers: range) -> dict[str, np.ndarray]:
    return measures(answers, _jobs(point, numbers), asked.hours, asked.best, asked.exposure)

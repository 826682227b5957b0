"""Which station stands where: flows between places, changes of the layout, first proposals, and the best simulated.

A change of the layout in words: ``swap press and wash and move packing to bay_7``.

Which layout to take, and whether one is clearly better or worse than the present one.

The layout study: flows of today, proposals, all simulated, the one to take, looked at again on fresh luck.

A layout study for machines.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from opsim.kpi.catalogue import LESS, MORE, AskedFigure, read_asked
from opsim.kpi.window import SECONDS_PER_HOUR
from opsim.layout import Ways, ways
from opsim.problems import enumerated, natural_key
from opsim.scenario.study_checks import Varied
from opsim.study.compare import holm, paired
from opsim.study.intervals import CONFIDENCE
from opsim.study.jobs import Answers, Job, Point
from opsim.study.layout.evaluate import (
    BEST,
    WALKED,
    Against,
    Flow,
    Flows,
    Proposals,
    against,
    exposure_asked,
    flows_of,
    measures,
    proposals,
)
from opsim.study.layout.floor import Floor, Movable, NoLayout, floor_of, movable
from opsim.study.layout.moves import Candidate, clash, what_ifs

if TYPE_CHECKING:
    from opsim.scenario.schema.scenario import Loaded


MOST_SAID, MOVE = 4, "move "


def said(before: Mapping[str, str], candidate: Candidate, *, brief: bool = False) -> str:
    """What to do so that today's layout (place of each station) becomes the other one, in few words.

    brief : of many moves only how many they are
    """
    steps = list(_steps(before, candidate))
    if len(steps) > MOST_SAID:
        moved = [name for name, place in candidate.at.items() if before.get(name) != place]
        if brief:
            return f"move {len(moved)} stations"
        return f"move {len(moved)} stations ({', '.join(f'{name} to {candidate.at[name]}' for name in moved)})"
    return enumerated([_short(step, before) for before, step in zip(["", *steps], steps)])


def _short(step: str, before: str) -> str:
    """``saw to b4`` after another move: ``move press to a3 and saw to b4``."""
    return step.removeprefix(MOVE) if before.startswith(MOVE) else step


def moved_stations(before: Mapping[str, str], candidate: Candidate) -> list[str]:
    """The stations that stand elsewhere than before."""
    return [name for name, place in candidate.at.items() if before.get(name, place) != place]


def _steps(before: Mapping[str, str], candidate: Candidate) -> Iterator[str]:
    moved = {name: candidate.at[name] for name in sorted(moved_stations(before, candidate), key=natural_key)}
    done: set[str] = set()
    for name, place in moved.items():
        if name in done:
            continue
        other = next((one for one in moved if before[one] == place and moved[one] == before[name]), None)
        if other is not None:
            done |= {name, other}
            yield f"swap {name} and {other}"
    for name, place in moved.items():
        if name not in done:
            yield f"{MOVE}{name} to {place}"
    for place, (x, y) in candidate.moved.items():
        yield f"put {place} at ({x:g} m, {y:g} m)"
    for name in candidate.added:
        yield f"add {name} at {candidate.at[name]}"


def gains(of: Mapping[str, Against], best: AskedFigure) -> list[str]:
    """Which of WALKED and BEST are clearly better than now."""
    better = of[BEST].less if best.better == LESS else of[BEST].more
    return [measure for measure, one in ((WALKED, of[WALKED].less), (BEST, better)) if one]


def losses(of: Mapping[str, Against], best: AskedFigure) -> list[str]:
    """Which of WALKED and BEST are clearly worse than now."""
    worse = of[BEST].more if best.better == LESS else of[BEST].less
    return [measure for measure, one in ((WALKED, of[WALKED].more), (BEST, worse)) if one]


def chosen(layouts: Mapping[str, Mapping[str, np.ndarray]], best: AskedFigure, now: str) -> tuple[str, list[str]]:
    """(the layout to take, those that no test tells from the best one): of these, the one with the least walking.

    Those that are clearly worse than the present one are not among them, even where no test tells them from the best.
    layouts : with the present one, ``now``, among them; a figure that is missing everywhere is worse than any
    """
    sign = -1.0 if best.better == LESS else 1.0
    names = list(layouts)
    goodness = {name: known_mean(sign * layouts[name][BEST], -np.inf) for name in names}
    top = max(names, key=goodness.__getitem__)
    alike = [top, *_not_worse(layouts, names, top, sign)]
    if top != now:
        kept = [now, *_not_worse(layouts, names, now, sign)]
        alike = [name for name in alike if name == top or name in kept]
    if best.kpi == "walked_m":
        return top, alike
    return min(alike, key=lambda name: (known_mean(layouts[name][WALKED], np.inf), names.index(name))), alike


def _not_worse(
    layouts: Mapping[str, Mapping[str, np.ndarray]], names: Sequence[str], base: str, sign: float
) -> list[str]:
    """The others that have the figure and are not clearly worse than ``base`` by it; tests held together (Holm)."""
    others = [name for name in names if name != base and np.isfinite(layouts[name][BEST]).any()]
    found = [paired(layouts[name][BEST].tolist(), layouts[base][BEST].tolist())[:2] for name in others]
    p = holm([one for _, one in found])
    return [
        name
        for name, (difference, _), one in zip(others, found, p)
        if not (one <= 1 - CONFIDENCE and sign * difference.mean < 0)
    ]


def known_mean(values: np.ndarray, otherwise: float = np.nan) -> float:
    """The mean of what is known; ``otherwise`` where nothing is."""
    known = values[np.isfinite(values)]
    return float(known.mean()) if known.size else otherwise


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
    def best(self) -> AskedFigure:
        return read_asked(self.block.best)

    @property
    def exposure(self) -> AskedFigure | None:
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


def asked_of(varied: Varied, loaded: Loaded, block: Any, variant: str | None, seed: int | None = None) -> LayoutAsked:
    """varied : the variant with its tree; loaded : the same, read. seed : instead of its own"""
    from opsim.scenario.tree import entries, text

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
    return ways(asked.floor.scenario.layout, one.moved) if one.moved else asked.floor.ways


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


def summary(found: LayoutFound) -> dict[str, Any]:
    """What came out, for machines."""
    return {
        "replications": found.asked.replications,
        "best": found.asked.best.name,
        "exposure": None if found.asked.exposure is None else found.asked.exposure.name,
        "taken": None if found.taken is None else found.taken.name,
        "gains": found.gains,
        "losses": found.losses,
        "alike": list(found.alike),
        "all_together_left_out": found.asked.clash or None,
        "fresh": {name: _numbers(one) for name, one in found.fresh.items()},
        "layouts": [_as_json(found, one) for one in found.candidates],
        "proposals": _made(found),
        "flows": [_flow_json(flow) for flow in found.flows.largest_first()],
        "walked_m_per_h": found.flows.walked_m_per_h,
    }


def _made(found: LayoutFound) -> dict[str, Any] | None:
    made = found.proposals
    if made is None:
        return None
    names = ("exact", "tried", "now_m_per_h", "best_m_per_h")
    return {name: getattr(made, name) for name in names}


def _as_json(found: LayoutFound, one: Candidate) -> dict[str, Any]:
    return {
        "name": one.name,
        "what": said(found.asked.floor.at, one),
        "proposed": one.proposed,
        "changes": dict(one.changes),
        "predicted_m_per_h": one.predicted_m_per_h,
        "against_now": {name: _numbers(of) for name, of in found.compared[one.name].items()},
    }


def _numbers(one: Against) -> dict[str, Any]:
    difference = one.difference
    return {
        "now": one.now.mean,
        "then": one.then.mean,
        "difference": difference.mean,
        "low": difference.low,
        "high": difference.high,
        "n": difference.n,
        "p": one.p,
        "p_holm": one.p_together,
    }


def _flow_json(flow: Flow) -> dict[str, Any]:
    return {
        "between": [flow.start, flow.end],
        "trips_per_h": float(flow.trips_per_h),
        "with_a_job_per_h": flow.with_a_job_per_h,
        "distance_m": flow.distance_m,
        "metres_per_h": float(flow.metres_per_h),
    }

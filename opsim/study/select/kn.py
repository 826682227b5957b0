"""Decisions of a fully sequential procedure at one replication: who beats whom, who keeps the limits, who is out.

How far apart sums have to be before anything is decided: the triangles of a fully sequential procedure.

Kim and Nelson's fully sequential procedure, with limits on other figures where they are asked for.

All systems run side by side; whoever is clearly beaten by another that keeps the limits, or is clearly beyond a limit,
is thrown out. Systems may share random numbers: their differences then vary less, and it ends sooner.

Sources: Kim & Nelson 2001, ACM TOMACS 11:251-273 (procedure KN, c = 1); limits: Andradottir & Kim 2010, Naval Research
Logistics 57:403-421 (feasibility and comparison at the same time); several limits: Batur & Kim 2010, ACM TOMACS 20(3).
KN++ (Kim & Nelson 2006), which estimates the spread anew as it goes, is left out: its promise holds only in the limit.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from opsim.kpi.catalogue import MORE
from opsim.study.select.constants import kn_eta
from opsim.study.select.selection import (
    CHOSEN,
    NONE_WITHIN,
    RAN_OUT,
    TIED,
    Asked,
    Limit,
    Observe,
    Out,
    Selection,
    Stage,
    plain_means,
    sign_of,
)

ROUNDING = 1e-9
"""Differences below this share of the sums are of the order in which numbers were added, not of the systems."""


@dataclass(slots=True)
class Race:
    """What is decided so far. beats : (k, k), 1 where row beat column; within : (k, L), 1 kept, -1 broken, 0 open."""

    alive: np.ndarray
    beats: np.ndarray
    within: np.ndarray
    n: np.ndarray


def decide(
    race: Race, sums: np.ndarray, pair_room: np.ndarray, limit_room: np.ndarray, asked: Asked, r: int
) -> list[Out]:
    """Every decision that can be taken at the r-th replication, each once and for all; who is thrown out by them."""
    over = np.where(np.abs(sums[:, 1:]) <= ROUNDING * r * _bounds(asked), 0.0, sums[:, 1:])
    race.within[(race.within == 0) & (over <= -limit_room)] = 1
    race.within[(race.within == 0) & (over > limit_room)] = -1
    apart = sums[:, None, 0] - sums[None, :, 0]
    apart[np.abs(apart) <= ROUNDING * np.abs(sums[:, 0]).max()] = 0.0
    race.beats[open_pairs(race) & (apart > pair_room)] = 1
    beyond = race.alive & (race.within < 0).any(axis=1)
    judges = race.alive & (race.within > 0).all(axis=1)
    beaten = race.alive & ~beyond & (race.beats[judges] > 0).any(axis=0)
    race.alive &= ~(beyond | beaten)
    found = []
    for i in np.flatnonzero(beyond | beaten):
        if beyond[i]:
            limit = asked.limits[int(np.argmax(race.within[i] < 0))].name
            found.append(Out(asked.systems[i], r, limit=limit))
        else:
            by = max(np.flatnonzero(judges & (race.beats[:, i] > 0)), key=lambda j: (race.alive[j], sums[j, 0], -j))
            found.append(Out(asked.systems[i], r, by=asked.systems[by]))
    return found


def _bounds(asked: Asked) -> np.ndarray:
    return np.array([abs(limit.bound) for limit in asked.limits])


def open_pairs(race: Race) -> np.ndarray:
    """(k, k) which two of those left nobody has told apart."""
    open_yet = race.alive[:, None] & race.alive[None] & (race.beats == 0) & (race.beats.T == 0)
    np.fill_diagonal(open_yet, False)
    return open_yet


def open_limits(race: Race) -> np.ndarray:
    """(k, L) of which limits nobody knows whether those left keep them."""
    return np.asarray(race.alive[:, None] & (race.within == 0))


def ended_how(race: Race, begun: np.ndarray, r: int, most: int) -> str:
    """How it ended; "" where it goes on. begun : (k, k) where triangles begin, 0 of two that never differed"""
    left = np.flatnonzero(race.alive)
    if not left.size:
        return NONE_WITHIN
    if (race.within[left] > 0).all():
        if left.size == 1:
            return CHOSEN
        if not begun[np.ix_(left, left)].any():
            return TIED
    return RAN_OUT if r >= most else ""


def names_of(asked: Asked, alive: np.ndarray) -> tuple[str, ...]:
    """The systems that are left. alive : (k,)"""
    return tuple(name for name, here in zip(asked.systems, alive) if here)


UNMOVED = 59
"""Replications before no spread at all is believed: what happens in 5 % of replications shows in so many of them but
with a chance of 0.95^59 < 0.05."""


class Rooms:
    """Where the triangles begin, by the spread of the first stage; a wider one closes later.

    A difference (or the figure of a limit) that is the same in the whole first stage says nothing of its spread: it may
    be a stop that is rare. Nothing is decided of it before ``look_again_at`` replications, which are its first stage.
    pairs : (k, k), limits : (k, L), of sums at replication 0; inf where nothing is decided yet
    """

    def __init__(self, asked: Asked, error: float, starts: np.ndarray):
        """starts : (k, n0, 1 + L) of the first stage, limits as by how much they are exceeded; error : of a decision"""
        self._asked, self._error = asked, error
        self._tolerances = np.array([limit.tolerance for limit in asked.limits])
        self.look_again_at = min(max(asked.first_stage, UNMOVED), asked.most)
        self.pairs, self.limits = self._begun(starts)
        if asked.first_stage < self.look_again_at:
            self.pairs[self.pairs == 0.0] = np.inf
            self.limits[self.limits == 0.0] = np.inf

    def look_again(self, alive: np.ndarray, values: np.ndarray) -> None:
        """values : (alive, look_again_at, 1 + L) as ``starts``"""
        pairs, limits = self._begun(values)
        grid = np.ix_(alive, alive)
        self.pairs[grid] = np.where(np.isinf(self.pairs[grid]), pairs, self.pairs[grid])
        self.limits[alive] = np.where(np.isinf(self.limits[alive]), limits, self.limits[alive])

    def at(self, r: int) -> tuple[np.ndarray, np.ndarray]:
        """(k, k) and (k, L): how much larger than 0 a sum has to be at the r-th replication."""
        return (
            np.maximum(0.0, self.pairs - 0.5 * self._asked.indifference * r),
            np.maximum(0.0, self.limits - 0.5 * self._tolerances * r),
        )

    def affordable(self, pairs: np.ndarray) -> float:
        """The indifference at which these pairs' triangles close at the last replication allowed; nan of none.

        pairs : (k, k), whether it counts
        """
        if not pairs.any():
            return float("nan")
        return float(np.sqrt(2.0 * self._asked.indifference * self.pairs[pairs].max() / self._asked.most))

    def _begun(self, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Source: Kim & Nelson 2001, h^2 S^2 / (2 c d) with c = 1 and h^2 = 2 c eta (n0 - 1)."""
        freedom = values.shape[1] - 1
        scale = 2.0 * kn_eta(freedom, self._error) * freedom
        figures, over = values[..., 0], values[..., 1:]
        pairs = np.array([_variances(of - figures, np.abs(figures).max(initial=0.0)) for of in figures])
        bounds = np.array([abs(limit.bound) for limit in self._asked.limits])
        limits = _variances(over.swapaxes(1, 2), bounds[None] + np.abs(over).max(axis=1, initial=0.0))
        return scale * pairs / (2.0 * self._asked.indifference), scale * limits / (2.0 * self._tolerances)


def _variances(values: np.ndarray, size: float | np.ndarray) -> np.ndarray:
    """Along the last axis; 0 where they differ by no more than rounding of numbers of this size."""
    return np.where(np.ptp(values, axis=-1) <= ROUNDING * size, 0.0, values.var(axis=-1, ddof=1))


ASSUMES = (
    "means of replications are normally distributed (nearly so where many jobs pass)",
    "replications of one variant are independent; variants may share random numbers",
    f"what does not vary in {UNMOVED} replications (or as many as are allowed) does not vary at all",
)


def kn(
    observe: Observe,
    systems: Sequence[str],
    *,
    indifference: float,
    confidence: float = 0.95,
    better: str = MORE,
    limits: Sequence[Limit] = (),
    first_stage: int = 10,
    batch: int = 10,
    most: int = 10_000,
) -> Selection:
    """The best of some systems whose means keep the limits, with a chance of at least ``confidence``.

    first_stage : replications from which the spread is known, 5 or more; of what does not vary in them at all
        nothing is decided before ``UNMOVED`` (or ``most``) replications
    batch : replications asked of every system left at a time. Decisions are taken replication by replication on the
        answers, as if asked one by one: it changes nothing but how many answers are not needed in the end.
    Raises ValueError where something asked is wrong, or an answer holds no number.
    """
    asked = Asked(tuple(systems), indifference, confidence, better, first_stage, most, tuple(limits))
    answered = asked.answered(observe)
    answered.upto(dict.fromkeys(range(asked.k), first_stage))
    # one system may lose its place by a limit of its own or to each other: so many decisions share the chance of error
    error = (1.0 - confidence) / (asked.k - 1 + len(asked.limits))
    starts = np.stack([_turned(asked, of) for of in answered.values])
    rooms = Rooms(asked, error, starts)
    race = Race(
        np.ones(asked.k, dtype=bool),
        np.zeros((asked.k, asked.k), dtype=np.int8),
        np.zeros((asked.k, len(asked.limits)), dtype=np.int8),
        np.full(asked.k, first_stage),
    )
    sums, stages, out = starts.sum(axis=1), [Stage(0, asked.systems)], list[Out]()
    r, ended = first_stage, ""
    while not ended:
        if r == rooms.look_again_at:
            alive = np.flatnonzero(race.alive)
            rooms.look_again(alive, np.stack([_turned(asked, answered.values[i][:r]) for i in alive]))
        pair_room, limit_room = rooms.at(r)
        race.n[race.alive] = r
        thrown = decide(race, sums, pair_room, limit_room, asked, r)
        if thrown:
            out += thrown
            stages.append(Stage(r, names_of(asked, race.alive)))
        ended = ended_how(race, rooms.pairs, r, most)
        if not ended:
            if r == min(answered.n[i] for i in np.flatnonzero(race.alive)):
                answered.upto(dict.fromkeys(map(int, np.flatnonzero(race.alive)), min(r + batch, most)))
            for i in np.flatnonzero(race.alive):
                sums[i] += _turned(asked, answered.values[i][r : r + 1])[0]
            r += 1
    if stages[-1].n != r:
        stages.append(Stage(r, names_of(asked, race.alive)))
    means, limited = plain_means(answered, race.n.tolist())
    left = names_of(asked, race.alive)
    return Selection(
        procedure="kn",
        systems=asked.systems,
        winner=left[0] if ended in (CHOSEN, TIED) else "",
        ended=ended,
        stages=tuple(stages),
        out=tuple(out),
        means=means,
        limited=limited,
        n=tuple(map(int, race.n)),
        asked=answered.n,
        confidence=confidence,
        indifference=indifference,
        promise=_promise(asked),
        assumes=ASSUMES,
        affordable=rooms.affordable(open_pairs(race)),
        open_pairs=tuple((systems[i], systems[j]) for i, j in np.argwhere(np.triu(open_pairs(race)))),
        open_limits=tuple((systems[i], asked.limits[c].name) for i, c in np.argwhere(open_limits(race))),
        tied=left if ended == TIED else (),
        values=tuple(answered.values),
    )


def _promise(asked: Asked) -> str:
    chance = f"with a chance of at least {100 * asked.confidence:.4g} %"
    if not asked.limits:
        return f"the best is chosen {chance} where it is at least the indifference better than every other"
    return (
        f"the best of those that keep the limits is chosen {chance} where it is at least the indifference better than "
        "every other of them; a mean nearer to a limit than its tolerance may be called either"
    )


def _turned(asked: Asked, values: np.ndarray) -> np.ndarray:
    """(n, 1 + limits) so that more is better in the first column, and above 0 is beyond a limit in the others."""
    turned = values * sign_of(asked.better)
    for column, limit in enumerate(asked.limits, 1):
        turned[:, column] = limit.over(values[:, column])
    return turned

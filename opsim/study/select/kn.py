"""Kim and Nelson's fully sequential procedure, with limits on other figures where they are asked for.

All systems run side by side; whoever is clearly beaten by another that keeps the limits, or is clearly beyond a limit,
is thrown out. Systems may share random numbers: their differences then vary less, and it ends sooner.

Sources: Kim & Nelson 2001, ACM TOMACS 11:251-273 (procedure KN, c = 1); limits: Andradottir & Kim 2010, Naval Research
Logistics 57:403-421 (feasibility and comparison at the same time); several limits: Batur & Kim 2010, ACM TOMACS 20(3).
KN++ (Kim & Nelson 2006), which estimates the spread anew as it goes, is left out: its promise holds only in the limit.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from opsim.kpi.better import MORE
from opsim.study.select.asking import Limit, Observe, sign_of
from opsim.study.select.race import Race, decide, ended_how, names_of, open_limits, open_pairs
from opsim.study.select.rooms import UNMOVED, Rooms
from opsim.study.select.selection import CHOSEN, TIED, Asked, Out, Selection, Stage, plain_means

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

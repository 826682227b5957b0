"""LFFRM: fatigue grows with time at work and fades with time off it.

Fatigue of one worker through time: told when he works and when he is broken off, he rests between.

Rest by need: who is too tired rests until he is not.

Errors: who is tired leaves more defects.

The time of day: people are quickest in the afternoon and slowest before dawn.

State-dependent pace: people go faster where they hold others up.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import cos, exp, inf, log, log1p, pi
from typing import Any, ClassVar

from opsim.subjects.human.catalogue import Checked, parameter

BY = ("even", "posture")


@dataclass(frozen=True, slots=True)
class Lffrm(Checked):
    """Fatigue F of 0 (fresh) to 1: 1 - (1 - F) exp(-lambda t) after t of work, F exp(-mu t) after t of rest.

    by : ``even``: all work tires alike; ``posture``: lambda times how heavy the task is beside the others, by its mean
         load on the joints (``opsim.subjects.human.muscle_fatigue``), an assumption

    Source: Jaber, Givi & Neumann 2013, their fatigue from a residual of the rest before, and their recovery. They give
    lambda of 0.01 to 0.05 as slow to fast; here lambda = ln 2 / tires_half_in_s, mu = ln 2 / recovers_half_in_s.
    That fatigue acts on log time in proportion, by slows at full fatigue, is an assumption.
    """

    does: ClassVar[str] = "fatigue grows with time at work, fades with rest, and slows"
    source: ClassVar[str] = (
        "Jaber, M. Y., Givi, Z. S. & Neumann, W. P. (2013). Incorporating human fatigue and recovery into the "
        "learning-forgetting process. Appl. Math. Model. 37, 7287-7299"
    )
    tires_half_in_s: float = parameter(
        14_400.0, "work after which half of what was fresh is tired", unit="s", neutral=inf, above=0.0, endless=True
    )
    recovers_half_in_s: float = parameter(1_200.0, "rest after which fatigue is half", unit="s", above=0.0)
    slows: float = parameter(
        0.2, "how much longer work takes at full fatigue", unit="share", neutral=0.0, at_least=0.0, at_most=10.0
    )
    by: str = parameter("even", "whether all work tires alike, or as heavy tasks are", words=BY)

    @property
    def needs_burden(self) -> bool:
        """Whether it asks how heavy tasks are."""
        return self.by == "posture"

    def fresh(self) -> float:
        """The fatigue of a rested person."""
        return 0.0

    def passed(
        self, state: float, heaviness: float, _first: float, _last: float, work_s: float, rest_s: float
    ) -> float:
        """Fatigue after some seconds of a task that is so many times as heavy as the mean, and some of rest then."""
        state = 1.0 - (1.0 - state) * exp(-_LN2 / self.tires_half_in_s * heaviness * work_s)
        return self.rested(state, rest_s) if rest_s > 0.0 else state

    def rested(self, state: float, seconds: float) -> float:
        """Fatigue after some seconds of rest."""
        return state * exp(-_LN2 / self.recovers_half_in_s * seconds)

    def level(self, state: float) -> float:
        """0 to 1."""
        return state

    def by_joint(self, _state: float) -> dict[str, float]:
        """It knows no joints."""
        return {}

    def shift(self, level: float) -> float:
        """Of log time: work takes exp(shift) times as long."""
        return log1p(self.slows) * level

    def rest_to_s(self, state: float, level: float) -> float:
        """Seconds of rest after which fatigue is no more than a level, above 0."""
        if state <= level:
            return 0.0
        return log(state / level) * self.recovers_half_in_s / _LN2


_LN2 = log(2.0)


class Tired:
    """model : one of ``subjects.human`` with fresh, passed, rested, level; burden_of : what it asks of a task, by rank.

    Time goes forward only. Engine and replay ask the same questions of the same code.
    """

    __slots__ = ("_begun_s", "_burden_of", "_done", "_task", "_until_s", "at_s", "burdens", "model", "state")

    def __init__(self, model: Any, burden_of: Callable[[int], Any]):
        self.model, self._burden_of = model, burden_of
        self.state = model.fresh()
        self.at_s = 0.0
        self.burdens: dict[int, Any] = {}
        self._task, self._begun_s, self._until_s, self._done = -1, 0.0, 0.0, 0.0

    def works(self, now: float, task: int, until_s: float, done: float = 0.0) -> None:
        """He works on a task from now, at share ``done`` of it, until it is done then."""
        if now > self.at_s:
            self.pass_to(now)
        self._task, self._begun_s, self._until_s, self._done = task, now, until_s, done

    def is_at(self, task: int, begun_s: float, until_s: float, done: float) -> None:
        """He works on a task (-1: none) since some time, begun at share ``done`` of it, until it is done then."""
        self._task, self._begun_s, self._until_s, self._done = task, begun_s, until_s, done

    def stops(self, now: float) -> None:
        """He works no more."""
        self.pass_to(now)
        self._task = -1

    def level_at(self, now: float) -> float:
        """0 (fresh) to 1."""
        self.pass_to(now)
        return float(self.model.level(self.state))

    def pass_to(self, now: float) -> None:
        """Time goes on until now."""
        at_s = self.at_s
        if now <= at_s:
            return
        self.at_s, task = now, self._task
        if task < 0:
            self.state = self.model.rested(self.state, now - at_s)
            return
        first, last, work_s, rest_s = piece(at_s, now, self._begun_s, self._until_s, self._done)
        if now >= self._until_s:
            self._task = -1
        if task in self.burdens:
            burden = self.burdens[task]
        else:
            burden = self.burdens[task] = self._burden_of(task)
        self.state = self.model.passed(self.state, burden, first, last, work_s, rest_s)


def piece(at_s: float, now: float, begun_s: float, until_s: float, done: float) -> tuple[float, float, float, float]:
    """What passes from a time until now of a performance that was begun at share ``done``, and goes on until then: from
    which share of it to which, how many seconds of work, and how many of rest after its end.
    """
    to_s, rest_s = now, 0.0
    if now >= until_s:
        to_s, rest_s = until_s, now - until_s
    if done == 0.0 and at_s == begun_s and to_s == until_s:  # NOTE: a whole performance, most often
        return 0.0, 1.0, to_s - at_s, rest_s
    a_second = (1.0 - done) / (until_s - begun_s)
    return done + a_second * (at_s - begun_s), min(1.0, done + a_second * (to_s - begun_s)), to_s - at_s, rest_s


def tired(model: Any, burdens: Any, worker: int) -> Tired:
    """A worker who is fresh at 0; ``burdens``: a ``Burdens`` of his plan."""
    if not model.needs_burden:
        return Tired(model, lambda _task: 1.0)
    if hasattr(model, "by"):
        return Tired(model, lambda task: burdens.heaviness(worker, task))
    return Tired(model, lambda task: model.felt(burdens.course(worker, task)))


@dataclass(frozen=True, slots=True)
class RestByNeed(Checked):
    """Who is free, and whose fatigue is above ``above``, takes a rest until it is down to ``until``.

    A rest by need is what people do where nobody plans their breaks; both levels are assumptions.
    """

    does: ClassVar[str] = "who is too tired rests until he is not"
    source: ClassVar[str] = (
        "the rule of rest of Jaber, M. Y. & Neumann, W. P. (2010). Modelling worker fatigue and recovery in "
        "dual-resource constrained systems. Comput. Ind. Eng. 59, 75-84, asked as fatigue passes a level"
    )
    above: float = parameter(
        0.5, "fatigue above which a rest begins", unit="share", neutral=1.0, above=0.0, at_most=1.0
    )
    until: float = parameter(0.2, "fatigue at which it ends", unit="share", above=0.0, below=1.0)

    def __post_init__(self) -> None:
        Checked.__post_init__(self)
        if self.until >= self.above:
            raise ValueError(f"until: found {self.until:g}, expected less than above, {self.above:g}")


@dataclass(frozen=True, slots=True)
class ErrorsByFatigue(Checked):
    """Fatigue leaves a defect in an operation by chance at_full_fatigue * level, level 0 (fresh) to 1 (exhausted).

    It comes on top of the station's yield and the worker's quality, which are those of fresh people: their shares of
    good work are multiplied. Source: that fatigue costs quality is well reported (Kolus, Wells & Neumann 2018); that it
    does so in proportion is an assumption, so the parameter has no source of its own.
    """

    does: ClassVar[str] = "the chance of a defect grows with fatigue"
    source: ClassVar[str] = (
        "Kolus, A., Wells, R. & Neumann, P. (2018). Production quality and human factors engineering: a systematic "
        "review and theoretical framework. Appl. Ergon. 73, 55-89"
    )
    at_full_fatigue: float = parameter(
        0.1,
        "chance of a defect, an operation, by somebody exhausted",
        unit="share",
        neutral=0.0,
        at_least=0.0,
        at_most=1.0,
    )

    def share_of_good(self, level: float) -> float:
        """The share of operations that fatigue leaves good."""
        return 1.0 - self.at_full_fatigue * min(1.0, max(0.0, level))


DAY_S = 86_400.0


@dataclass(frozen=True, slots=True)
class Circadian(Checked):
    """The shift of log time is -amplitude cos(2 pi (clock - peak) / 24 h): its mean over a day is 0.

    Source: the circadian process of the three-process model (Akerstedt & Folkard 1997), a cosine with its top at 16.8 h
    (16:48); that log time follows alertness in proportion, and the amplitude, are assumptions.
    """

    does: ClassVar[str] = "pace follows a cosine by the clock, best at its peak, worst twelve hours off"
    source: ClassVar[str] = (
        "Akerstedt, T. & Folkard, S. (1997). The three-process model of alertness and its extension to performance, "
        "sleep latency, and sleep length. Chronobiol. Int. 14, 115-123"
    )
    amplitude: float = parameter(
        0.05, "log of time won at the peak and lost twelve hours off", neutral=0.0, at_least=0.0, at_most=1.0
    )
    peak_s: float = parameter(
        60_480.0, "time of the day at which people are quickest", unit="s", at_least=0.0, below=DAY_S
    )

    def shift(self, clock_s: float) -> float:
        """By how much log time shifts at seconds after any midnight."""
        return -self.amplitude * cos(2.0 * pi * (clock_s - self.peak_s) / DAY_S)


@dataclass(frozen=True, slots=True)
class Schultz(Checked):
    """The shift of log time is -faster * max(0, before - after) + slower * max(0, after - before).

    before, after : how full the buffers before and behind the station are, 0 empty, 1 full; a side where nobody is
    held up counts as ``NEUTRAL_SHARE``. So who has a full buffer before him and an empty one behind him takes
    exp(-faster) of his time.

    He is seen as he begins: without any buffers nobody waits for him then, and he goes at his own pace.

    Source: Schultz et al. (1998), who saw people speed up where they were the cause of idle time, enough to make up for
    all that blocking and starving had cost, and Schultz, Juran & Boudreau (1999). Neither gives a formula: that it is
    linear in the difference of shares, and the defaults, are assumptions.
    """

    does: ClassVar[str] = "people speed up where the buffer before them is fuller than the one behind them"
    source: ClassVar[str] = (
        "Schultz, K. L., Juran, D. C., Boudreau, J. W., McClain, J. O. & Thomas, L. J. (1998). Modeling and worker "
        "motivation in JIT production systems. Manage. Sci. 44, 1595-1607"
    )
    faster: float = parameter(
        0.1,
        "log of time won where the buffer before is full and the one behind empty",
        neutral=0.0,
        at_least=0.0,
        at_most=2.0,
    )
    slower: float = parameter(
        0.0,
        "log of time lost where the buffer before is empty and the one behind full",
        neutral=0.0,
        at_least=0.0,
        at_most=2.0,
    )
    full_at: float = parameter(10.0, "jobs that fill a buffer without limit", unit="jobs", above=0.0)

    def shift(self, before: float, after: float) -> float:
        """By how much log time shifts, given how full the buffers are."""
        ahead = before - after
        return self.slower * max(0.0, -ahead) - self.faster * max(0.0, ahead)

    def share(self, waiting: float, places: float) -> float:
        """How full a buffer is: 1 where somebody waits for one that does not exist."""
        room = min(places, self.full_at) if places == inf else places
        if room <= 0.0:
            return 1.0 if waiting > 0 else 0.0
        return min(1.0, waiting / room)


NEUTRAL_SHARE = 0.5
"""Of a side where nobody is held up: before stations that take from outside only, behind those that jobs leave from."""

"""Distributions of times: ``dist: NAME`` and its parameters. Each says itself in a few words and knows its mean."""

from __future__ import annotations

import math
from typing import Annotated, Literal

from pydantic import AfterValidator, Field, model_validator

from opsim.scenario.fields import Seconds, SecondsOrZero, Whole, plain_error
from opsim.scenario.tree import DIST
from opsim.subjects.tasks.words import TaskBlock
from opsim.task_model import log_variance, within_cv

SMALLEST_CV = 1e-3


def _cv(value: float) -> float:
    if 0 < value < SMALLEST_CV:
        raise plain_error(f"must be 0 or at least {SMALLEST_CV:g}, found {value:g}", "cv: 0 is always the same time")
    return value


MEAN = Field(alias="mean", description="mean over all workers", examples=["20 s"])
SHARE = Field(
    0.0, ge=0, le=1, description="share of the variance of log time, ln(1 + cv^2), between workers", examples=[0.3]
)
Cv = Annotated[float, Field(ge=0, le=10, description="sd / mean; 0: always the same time"), AfterValidator(_cv)]


def between_words(between_share: float) -> str:
    """How a share between workers is added to the words of a distribution."""
    return f", {between_share:.0%} of it between workers" if between_share else ""


class Exponential(TaskBlock):
    """Memoryless: standard deviation equal to the mean."""

    dist: Literal["exponential"] = DIST
    mean_s: Seconds = MEAN

    @property
    def words(self) -> str:
        return f"exponential, mean {self.mean_s:g} s"


class Erlang(TaskBlock):
    """The sum of k exponential phases: cv = 1 / sqrt(k)."""

    dist: Literal["erlang"] = DIST
    mean_s: Seconds = MEAN
    k: Whole = Field(ge=1, le=1_000_000, description="number of phases", examples=[2])

    @property
    def words(self) -> str:
        return f"erlang of {self.k}, mean {self.mean_s:g} s"


class Geometric(TaskBlock):
    """A whole number of steps, with the same chance to end after each: the exponential of a clock that ticks."""

    dist: Literal["geometric"] = DIST
    mean_s: Seconds = MEAN
    step_s: Seconds = Field(alias="step", description="time of one step, at most the mean", examples=["1 s"])

    @property
    def words(self) -> str:
        return f"geometric, mean {self.mean_s:g} s in steps of {self.step_s:g} s"

    @model_validator(mode="after")
    def _at_least_one_step(self) -> Geometric:
        if self.step_s > self.mean_s:
            raise plain_error(f"a step ({self.step_s:g} s) is longer than the mean ({self.mean_s:g} s)", on="step")
        return self


class Shared(TaskBlock):
    """A distribution by mean and cv; a share of its spread may lie between workers."""

    mean_s: Seconds = MEAN
    cv: Cv = Field(examples=[0.25])
    between_share: float = SHARE

    @property
    def words(self) -> str:
        name = self.dist  # type: ignore[attr-defined]
        return f"{name}, mean {self.mean_s:g} s, cv {self.cv:g}{between_words(self.between_share)}"


class Lognormal(Shared):
    """Lognormal, by its mean and cv."""

    dist: Literal["lognormal"] = DIST


class Gamma(Shared):
    """Gamma, by its mean and cv."""

    dist: Literal["gamma"] = DIST


class Weibull(Shared):
    """Weibull, by its mean and cv."""

    dist: Literal["weibull"] = DIST


class Hyperexponential(Shared):
    """One of two exponentials with balanced means: each gives half of the mean; cv at least 1."""

    dist: Literal["hyperexponential"] = DIST

    @model_validator(mode="after")
    def _more_than_exponential(self) -> Hyperexponential:
        if self.cv < 1:
            raise plain_error(f"the cv must be at least 1, found {self.cv:g}", "below 1, take gamma or erlang", on="cv")
        if within_cv(self.cv, self.between_share) < 1 - 1e-9:
            most = 1 - math.log(2) / log_variance(self.cv)
            found = f"with cv {self.cv:g} at most {most:.3f} can lie between workers, found {self.between_share:g}"
            raise plain_error(found, "else a worker's own cv would be below 1", on="between_share")
        return self


_LOW = Field(alias="low", description="shortest time", examples=["15 s"])
_HIGH = Field(alias="high", description="longest time", examples=["25 s"])
_WIDEST = 0.99
"""Of the widest spread that a family can have at its mean and bounds: beyond, its parameters run away."""


def _low_below_high(low_s: float, high_s: float) -> None:
    if low_s >= high_s:
        raise plain_error(f"low ({low_s:g} s) must be less than high ({high_s:g} s)", on="low")


def _inside(what: str, value_s: float, low_s: float, high_s: float) -> None:
    found = f"the {what} ({value_s:g} s) must lie between low ({low_s:g} s) and high ({high_s:g} s)"
    if not low_s <= value_s <= high_s:
        raise plain_error(found, on=what)


class Uniform(TaskBlock):
    """Anything from low to high, equally likely."""

    dist: Literal["uniform"] = DIST
    low_s: SecondsOrZero = _LOW
    high_s: Seconds = _HIGH

    @property
    def mean_s(self) -> float:
        return (self.low_s + self.high_s) / 2

    @property
    def words(self) -> str:
        return f"uniform, {self.low_s:g} to {self.high_s:g} s"

    @model_validator(mode="after")
    def _low_below_high(self) -> Uniform:
        _low_below_high(self.low_s, self.high_s)
        return self


class Triangular(TaskBlock):
    """From low to high, most likely the mode."""

    dist: Literal["triangular"] = DIST
    low_s: SecondsOrZero = _LOW
    mode_s: SecondsOrZero = Field(alias="mode", description="the time that is most likely", examples=["18 s"])
    high_s: Seconds = _HIGH

    @property
    def mean_s(self) -> float:
        return (self.low_s + self.mode_s + self.high_s) / 3

    @property
    def words(self) -> str:
        return f"triangular, {self.low_s:g} to {self.high_s:g} s, most likely {self.mode_s:g} s"

    @model_validator(mode="after")
    def _in_order(self) -> Triangular:
        _low_below_high(self.low_s, self.high_s)
        _inside("mode", self.mode_s, self.low_s, self.high_s)
        return self


class _Spread(TaskBlock):
    """A mean, and a spread as cv or as sd."""

    mean_s: Seconds = MEAN
    cv: Cv | None = Field(None, examples=[0.25])
    sd_s: SecondsOrZero | None = Field(None, alias="sd", description="standard deviation, instead of cv")
    between_share: float = SHARE

    @property
    def spread(self) -> float:
        """The cv, however it was given."""
        return self.cv if self.cv is not None else (self.sd_s or 0.0) / self.mean_s

    def _check_spread(self, most_s: float, why: str) -> None:
        """Said once, and not wider for a single worker than the family can be."""
        if self.cv is None and self.sd_s is None:
            raise plain_error("nothing says how far the times spread", "add e.g. 'cv: 0.25' or 'sd: 5 s'")
        if self.cv is not None and self.sd_s is not None:
            raise plain_error("the spread comes from cv and from sd", "keep one of them", on="sd")
        if within_cv(self.spread, self.between_share) * self.mean_s > _WIDEST * most_s:
            found = f"an sd of {self.spread * self.mean_s:g} s is too wide here; at most {_WIDEST * most_s:g} s"
            raise plain_error(found, why, on="sd" if self.cv is None else "cv")


class Normal(_Spread):
    """Normal, cut off below ``low``; mean and spread are those that remain after the cut."""

    dist: Literal["normal"] = DIST
    low_s: SecondsOrZero = Field(0.0, alias="low", description="no time is shorter", examples=["0 s"])

    @property
    def words(self) -> str:
        cut = f"none below {self.low_s:g} s"
        return f"normal, mean {self.mean_s:g} s, cv {self.spread:.3g}, {cut}{between_words(self.between_share)}"

    @model_validator(mode="after")
    def _possible(self) -> Normal:
        if self.low_s >= self.mean_s:
            raise plain_error(f"low ({self.low_s:g} s) must be less than the mean ({self.mean_s:g} s)", on="low")
        self._check_spread(self.mean_s - self.low_s, "so wide a normal, cut off at low, is none: take gamma")
        return self


class Beta(_Spread):
    """From low to high with the given mean and spread. With ``between_share`` a worker's bounds shift with his pace."""

    dist: Literal["beta"] = DIST
    low_s: SecondsOrZero = _LOW
    high_s: Seconds = _HIGH

    @property
    def words(self) -> str:
        bounds = f"{self.low_s:g} to {self.high_s:g} s"
        return f"beta, {bounds}, mean {self.mean_s:g} s, cv {self.spread:.3g}{between_words(self.between_share)}"

    @model_validator(mode="after")
    def _possible(self) -> Beta:
        _low_below_high(self.low_s, self.high_s)
        _inside("mean", self.mean_s, self.low_s, self.high_s)
        most_s = math.sqrt((self.mean_s - self.low_s) * (self.high_s - self.mean_s))
        self._check_spread(most_s, "more does not fit between low and high")
        return self


class Empirical(TaskBlock):
    """Drawn from the smoothed distribution of the values: linear between them, none beyond the smallest and largest."""

    dist: Literal["empirical"] = DIST
    values_s: Annotated[list[Seconds], Field(min_length=2, max_length=100_000)] = Field(
        alias="values", description="times that were seen", examples=["[18 s, 20 s, 25 s]"]
    )

    @property
    def mean_s(self) -> float:
        return math.fsum(self.values_s) / len(self.values_s)

    @property
    def words(self) -> str:
        return f"empirical, {len(self.values_s)} values, mean {self.mean_s:g} s"

"""Times from 0 upwards: ``dist: NAME`` and its parameters. Each says itself in a few words and knows its mean."""

from __future__ import annotations

import math
from typing import Annotated, Literal

from pydantic import AfterValidator, Field, model_validator

from opsim.scenario.fields import Seconds, Whole, plain_error
from opsim.scenario.schema.base import DIST
from opsim.scenario.schema.tasks import TaskBlock
from opsim.variability import log_variance, within_cv

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

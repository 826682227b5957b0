"""Which kind of task a block is: one of ``emulator``, ``motions``, ``fixed``, ``recorded``, ``dist`` stands in it."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import BeforeValidator, Discriminator, Tag

from opsim.problems import did_you_mean, shown
from opsim.scenario.fields import plain_error
from opsim.scenario.schema.bounded import Beta, Empirical, Normal, Triangular, Uniform
from opsim.scenario.schema.distributions import (
    Erlang,
    Exponential,
    Gamma,
    Geometric,
    Hyperexponential,
    Lognormal,
    Weibull,
)
from opsim.scenario.schema.motions import Motions
from opsim.scenario.schema.tasks import Emulated, Fixed, Plugged, Recorded, TaskBlock

DISTRIBUTIONS: dict[str, type[TaskBlock]] = {
    "exponential": Exponential,
    "lognormal": Lognormal,
    "gamma": Gamma,
    "uniform": Uniform,
    "erlang": Erlang,
    "geometric": Geometric,
    "weibull": Weibull,
    "triangular": Triangular,
    "normal": Normal,
    "hyperexponential": Hyperexponential,
    "beta": Beta,
    "empirical": Empirical,
}
TASK_KINDS: dict[str, type[TaskBlock]] = {
    "<emulator>": Emulated,
    "<motions>": Motions,
    "<plugin>": Plugged,
    "<fixed>": Fixed,
    "<recorded>": Recorded,
    **{f"<{name}>": model for name, model in DISTRIBUTIONS.items()},
}
KIND_KEYS = ("emulator", "motions", "plugin", "fixed", "recorded", "dist")


def _one_kind(value: object) -> object:
    """A task says in exactly one way where its time comes from."""
    if not isinstance(value, dict):
        raise plain_error(f"expected a block of keys, found {shown(value)}", "such as {fixed: 20 s}")
    kinds = [key for key in KIND_KEYS if key in value]
    if not kinds:
        near = next((hint for key in value if (hint := did_you_mean(key, KIND_KEYS)).startswith("did")), "")
        raise plain_error(
            "nothing says how long this task takes", near or "add one of: emulator, motions, fixed, recorded, dist"
        )
    if len(kinds) > 1:
        raise plain_error(f"the time comes from {kinds[0]} and from {kinds[1]}", "keep one of them", on=kinds[1])
    if kinds == ["dist"] and value["dist"] not in list(DISTRIBUTIONS):
        hint = did_you_mean(value["dist"], DISTRIBUTIONS)
        raise plain_error(f"unknown distribution {shown(value['dist'])}", hint, on="dist")
    return value


def _kind_tag(value: Any) -> str:
    kind = next(key for key in KIND_KEYS if key in value)
    return f"<{value['dist']}>" if kind == "dist" else f"<{kind}>"


Task = Annotated[
    Annotated[Emulated, Tag("<emulator>")]
    | Annotated[Motions, Tag("<motions>")]
    | Annotated[Plugged, Tag("<plugin>")]
    | Annotated[Fixed, Tag("<fixed>")]
    | Annotated[Recorded, Tag("<recorded>")]
    | Annotated[Exponential, Tag("<exponential>")]
    | Annotated[Lognormal, Tag("<lognormal>")]
    | Annotated[Gamma, Tag("<gamma>")]
    | Annotated[Uniform, Tag("<uniform>")]
    | Annotated[Erlang, Tag("<erlang>")]
    | Annotated[Geometric, Tag("<geometric>")]
    | Annotated[Weibull, Tag("<weibull>")]
    | Annotated[Triangular, Tag("<triangular>")]
    | Annotated[Normal, Tag("<normal>")]
    | Annotated[Hyperexponential, Tag("<hyperexponential>")]
    | Annotated[Beta, Tag("<beta>")]
    | Annotated[Empirical, Tag("<empirical>")],
    Discriminator(_kind_tag),
    BeforeValidator(_one_kind),
]

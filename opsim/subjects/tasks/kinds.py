"""What a task may be, and what else takes time: motions in a row, walking, plain times.

``TASK_KINDS`` is the table of tasks: one of the keys ``KIND_KEYS`` stands in the block, and with ``dist`` its name.
"""

from __future__ import annotations

from functools import reduce
from operator import or_
from typing import TYPE_CHECKING, Annotated, Any

from pydantic import AfterValidator, BeforeValidator, Discriminator, Field, Tag

from opsim.problems import did_you_mean, shown
from opsim.scenario.fields import Seconds, WalkLength, Whole, plain_error
from opsim.scenario.tree import Block
from opsim.subjects.tasks.distribution_words import (
    Beta,
    Empirical,
    Erlang,
    Exponential,
    Gamma,
    Geometric,
    Hyperexponential,
    Lognormal,
    Normal,
    Triangular,
    Uniform,
    Weibull,
)
from opsim.subjects.tasks.words import Emulated, Fixed, Plugged, Recorded, TaskBlock

MOST_MOTIONS = 200
"""In one task, repeats counted."""
_EXAMPLE = "such as work/reach, {walk: 3 m} or {emulator: work/fasten, repeat: 4}"
_WHAT = ("emulator", "walk")


class Step(Block):
    """One of the motions of a task, as often as it is repeated: of an emulator, or walking some way."""

    emulator: str | None = Field(None, description="library/task", examples=["work/fasten"])
    walk_m: WalkLength | None = Field(
        None, alias="walk", description="a walk of this length, as in 'walking:'", examples=["3 m"]
    )
    repeat: Whole = Field(1, ge=1, le=MOST_MOTIONS, description="how often, each with a draw of its own", examples=[2])

    @property
    def words(self) -> str:
        """In a few words, e.g. ``work/fasten x 4``."""
        what = f"walk {self.walk_m:g} m" if self.emulator is None else self.emulator
        return what if self.repeat == 1 else f"{what} x {self.repeat}"


def _one_step(value: object) -> object:
    """A text, or a block that says one motion."""
    if isinstance(value, str):
        return value
    if isinstance(value, list):
        raise plain_error("a list of motions inside a list of motions", "write them in one list, one after the other")
    if not isinstance(value, dict):
        raise plain_error(f"expected a motion, found {shown(value)}", _EXAMPLE)
    if "motions" in value:
        raise plain_error("motions inside motions", "write them in one list, one after the other", on="motions")
    said = [key for key in _WHAT if key in value]
    if len(said) > 1:
        raise plain_error("a motion of an emulator, and a walk", "make them two of the list", on="walk")
    if not said:
        near = next((hint for key in value if (hint := did_you_mean(key, _WHAT)).startswith("did")), "")
        raise plain_error("nothing says which motion this is", near or _EXAMPLE)
    if value[said[0]] is None:
        needed = "how far" if said == ["walk"] else "of which emulator"
        raise plain_error(f"nothing says {needed}", "such as {walk: 3 m}" if said == ["walk"] else _EXAMPLE, on=said[0])
    return value


def _step_tag(value: Any) -> str:
    return "<motion>" if isinstance(value, str) else "<step>"


Motion = Annotated[
    Annotated[str, Tag("<motion>")] | Annotated[Step, Tag("<step>")],
    Discriminator(_step_tag),
    BeforeValidator(_one_step),
]


def _not_too_many(value: object) -> object:
    """A list of motions that can be had; what is wrong with a single one is said there."""
    if not isinstance(value, list):
        raise plain_error(f"expected a list of motions, found {shown(value)}", "write them in [ ], " + _EXAMPLE)
    if not value:
        raise plain_error("expected at least one motion, found none", _EXAMPLE)
    repeats = [step.get("repeat", 1) if isinstance(step, dict) else 1 for step in value]
    n = sum(r for r in repeats if isinstance(r, int) and not isinstance(r, bool) and 1 <= r <= MOST_MOTIONS)
    if n > MOST_MOTIONS:
        raise plain_error(
            f"expected at most {MOST_MOTIONS} motions with their repeats, found {n:,}", "make it two tasks"
        )
    return value


class Motions(TaskBlock):
    """Several motions in a row, each with a draw of its own, joined where postures meet; their times add up."""

    motions: Annotated[list[Motion], BeforeValidator(_not_too_many)] = Field(
        description="motions one after the other: library/task, {walk: 3 m}, or {emulator: library/task, repeat: 4}",
        examples=["[work/reach, {walk: 3 m}, {emulator: work/fasten, repeat: 4}]"],
    )

    @property
    def steps(self) -> list[Step]:
        """All motions as blocks."""
        return [Step.model_validate({"emulator": one}) if isinstance(one, str) else one for one in self.motions]

    @property
    def words(self) -> str:
        return f"motions: {', '.join(step.words for step in self.steps)}"


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
    if "hands" in value and kinds != ["emulator"]:
        hint = "take 'emulator', or remove 'hands'"
        raise plain_error(f"hands go where an emulator moves them, and this task has {kinds[0]!r}", hint, on="hands")
    return value


def _kind_tag(value: Any) -> str:
    kind = next(key for key in KIND_KEYS if key in value)
    return f"<{value['dist']}>" if kind == "dist" else f"<{kind}>"


if TYPE_CHECKING:
    Task = TaskBlock
else:
    _ways = reduce(or_, (Annotated[model, Tag(tag)] for tag, model in TASK_KINDS.items()))
    Task = Annotated[_ways, Discriminator(_kind_tag), BeforeValidator(_one_kind)]


class Walking(Block):
    """Postures for all walking, from an emulator of cyclic motion; how long a walk takes stays distance / speed."""

    emulator: str = Field(
        description="library/task of an emulator of walking: gives the postures of all walks; times stay the same",
        examples=["walking/walk"],
    )

    @property
    def library(self) -> str:
        return self.emulator.partition("/")[0]

    @property
    def library_task(self) -> str:
        return self.emulator.partition("/")[2]


_OF_TASKS = {**{name: field.alias or name for name, field in TaskBlock.model_fields.items()}, "between_share": ""}
"""What only work of a worker has, by attribute: the key in the file."""


def _time_alone(block: TaskBlock) -> TaskBlock:
    if isinstance(block, Emulated | Motions | Plugged):
        raise plain_error("a time without a body is wanted here", "take fixed, recorded or dist")
    given = block.model_fields_set & set(_OF_TASKS)
    if given:
        key = _OF_TASKS[min(given)] or min(given)
        raise plain_error(f"{key!r} means nothing here", "remove it", on=key)
    return block


def _tag(value: object) -> str:
    return "<model>" if isinstance(value, dict | TaskBlock) else "<time>"


TimeModel = Annotated[Task, AfterValidator(_time_alone)]
"""A block that says a time, such as {dist: exponential, mean: 10 min}."""
PlainTime = Annotated[Annotated[Seconds, Tag("<time>")] | Annotated[TimeModel, Tag("<model>")], Discriminator(_tag)]
"""A time, always the same, or a block that says where it comes from."""

"""A task of several motions in a row: ``motions: [work/reach, {walk: 3 m}, {emulator: work/fasten, repeat: 4}]``."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import BeforeValidator, Discriminator, Field, Tag

from opsim.problems import did_you_mean, shown
from opsim.scenario.fields import WalkLength, Whole, plain_error
from opsim.scenario.schema.base import Block
from opsim.scenario.schema.tasks import TaskBlock

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

"""Times in which nobody moves, such as repairs: fixed, recorded or from a distribution, and nothing besides."""

from __future__ import annotations

from typing import Annotated

from pydantic import AfterValidator, Discriminator, Tag

from opsim.scenario.fields import Seconds, plain_error
from opsim.scenario.schema.motions import Motions
from opsim.scenario.schema.task_kinds import Task
from opsim.scenario.schema.tasks import Emulated, Plugged, TaskBlock

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


def mean_s(time: float | TaskBlock) -> float | None:
    """Mean of a plain time in seconds; None where a file has to be read first."""
    return time if isinstance(time, float) else getattr(time, "mean_s", None)

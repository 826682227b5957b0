"""How jobs come in."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Discriminator, Field, Tag, model_validator

from opsim.scenario.fields import Seconds, plain_error
from opsim.scenario.schema.base import Block
from opsim.scenario.schema.motions import Motions
from opsim.scenario.schema.task_kinds import Task
from opsim.scenario.schema.tasks import Emulated, Plugged, TaskBlock


def _gap_tag(value: object) -> str:
    return "<model>" if isinstance(value, dict | TaskBlock) else "<time>"


Gap = Annotated[Annotated[Seconds, Tag("<time>")] | Annotated[Task, Tag("<model>")], Discriminator(_gap_tag)]


class Release(Block):
    """How jobs come in."""

    kind: Literal["saturated", "poisson", "renewal"] = Field(
        description="saturated: whenever the first buffer has room; poisson: at random; renewal: gaps as given",
        examples=["poisson"],
    )
    every: Gap | None = Field(
        None, description="poisson: mean time between two jobs; renewal: where that time comes from", examples=["55 s"]
    )
    when_full: Literal["wait", "lose"] = Field("wait", description="what a job does that finds the first buffer full")

    @property
    def gap(self) -> TaskBlock | None:
        """Where the times between jobs come from (renewal), as a time of a task; else None."""
        return self.every if isinstance(self.every, TaskBlock) else None

    @property
    def every_s(self) -> float | None:
        """Mean time between two jobs; None for a saturated release, and where a file of times has to be read first."""
        return getattr(self.every, "mean_s", None) if isinstance(self.every, TaskBlock) else self.every

    @model_validator(mode="after")
    def _every_where_it_means_something(self) -> Release:
        if self.kind == "saturated" and self.every is not None:
            raise plain_error("a saturated release has no 'every': a job enters whenever there is room", on="every")
        if self.kind == "saturated" and self.when_full == "lose":
            raise plain_error("a saturated release loses nothing", "remove 'when_full'", on="when_full")
        if self.kind == "poisson" and self.every is None:
            raise plain_error("a poisson release needs the mean time between two jobs", "add e.g. 'every: 55 s'")
        if self.kind == "poisson" and self.gap is not None:
            raise plain_error(
                "a poisson release has exponential gaps", "write 'kind: renewal', or e.g. 55 s", on="every"
            )
        if self.kind == "renewal" and self.gap is None:
            found = "a renewal release needs to know where the time between two jobs comes from"
            hint = "such as {fixed: 55 s} or {dist: erlang, mean: 55 s, k: 2}"
            raise plain_error(found, hint, on=None if self.every is None else "every")
        self._check_gap()
        return self

    def _check_gap(self) -> None:
        """A gap between jobs is a time and nothing else."""
        if isinstance(self.gap, Emulated | Motions | Plugged):
            raise plain_error("nobody moves between two jobs", "take fixed, recorded or dist", on="every")
        given = set() if self.gap is None else self.gap.model_fields_set & set(_NOT_OF_A_GAP)
        if given:
            raise plain_error(f"a gap between jobs has no {_NOT_OF_A_GAP[min(given)]!r}", "remove it", on="every")


_NOT_OF_A_GAP = {"load_kg": "load", "repeat": "repeat", "automatic": "automatic", "between_share": "between_share"}

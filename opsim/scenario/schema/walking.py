"""How workers walk between places: with the postures of a walking emulator. Without it walking has times alone."""

from __future__ import annotations

from pydantic import Field

from opsim.scenario.schema.base import Block


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

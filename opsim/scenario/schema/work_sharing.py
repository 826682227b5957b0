"""Work sharing: the last tasks of a station, which the next one may do instead."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from opsim.scenario.fields import NameText
from opsim.scenario.schema.base import Block


class Share(Block):
    """Work that two neighbours share: the last tasks here may be left to the next station, which does them first.

    When the tasks before are done, the station looks at the next one. Where a server is free there, or less than so
    much of its buffer is taken, the job goes on as it is; else the shared task is done here, and it is looked again
    before another one. A task that was begun is finished where it was begun.
    """

    tasks: list[NameText] = Field(
        min_length=1, description="the last of the station's tasks, in their order", examples=["[lid]"]
    )
    partner: NameText = Field(
        alias="with", description="the next station on the way of every job that comes here", examples=["closing"]
    )
    when: Literal["half_full", "full"] = Field(
        "half_full",
        description="the station does the work itself where the next one's buffer is at least half full, or full",
    )

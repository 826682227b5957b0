"""``studies:``: what is asked of a scenario beside running it; each verb of the command line has a block here."""

from __future__ import annotations

from pydantic import Field

from opsim.scenario.schema.base import Block
from opsim.scenario.schema.studies.labour import Labour
from opsim.scenario.schema.studies.layout import LayoutStudy
from opsim.scenario.schema.studies.select import Select
from opsim.scenario.schema.studies.sweep import Sweep


class Studies(Block):
    """What is asked of a scenario beside running it. It decides nothing of what happens on the floor."""

    sweep: Sweep | None = Field(None, description="``opsim sweep``: many points of some factors")
    select: Select | None = Field(None, description="``opsim select``: the best of several variants")
    labour: Labour | None = Field(None, description="``opsim labour``: what differences between people cost")
    layout: LayoutStudy | None = Field(None, description="``opsim layout``: which station stands where")

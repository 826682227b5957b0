"""Where hands go at a mark of a movement: to one height, by product, or to one layer after the other.

Tasks: how long a piece of work takes, said in exactly one way.
"""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Discriminator, Field, Tag, WithJsonSchema, model_validator

from opsim import units
from opsim.problems import shown
from opsim.scenario.fields import Load, NameText, Seconds, Whole, plain_error
from opsim.scenario.tree import Block
from opsim.subjects.exposure.words import Handling, Loaded
from opsim.subjects.shifts.words import RULES
from opsim.subjects.tools.words import ATTENDED, Automatic, Hold, Needs

HEIGHT, LAYERS, BY_PRODUCT = "<height>", "<layers>", "<by product>"
_HAND = "such as rack.low, a level of a place, or 0.4 m above the floor"


def hand_height(value: object) -> float | tuple[str, str]:
    """Metres above the floor, or (place, level): of ``0.4 m`` and of ``rack.low``. Raises an error in our words."""
    if isinstance(value, str):
        place, _, level = (part.strip() for part in value.rpartition("."))
        is_number = value.strip()[:1] in "+-.0123456789"
        if place and level and not (is_number and (level[0].isdecimal() or place.lstrip("+-").isdecimal())):
            return place, level
        if not is_number:
            raise plain_error(f"expected a height, found {shown(value)}", _HAND)
    try:
        height_m = units.parse(value, "length")
    except units.UnitError as error:
        raise plain_error(error.message, error.hint or _HAND) from None
    if height_m < 0:
        raise plain_error(f"must be at least 0 m, found {shown(value)}", "heights count from the floor")
    return height_m


HandHeight = Annotated[
    float | tuple[str, str],
    BeforeValidator(hand_height),
    WithJsonSchema({"type": "string", "pattern": r"\S", "examples": ["rack.low", "0.4 m"]}),
]


class Layers(Block):
    """Heights that are used up in turn, as a pallet empties; after the last one comes a new full pallet."""

    layers: list[HandHeight] = Field(
        min_length=1,
        description="heights in the order in which they are used up",
        examples=["[pallet.top, pallet.middle, pallet.bottom]"],
    )
    pieces_each: Annotated[Whole, Field(ge=1)] = Field(
        description="how many times the task is begun at each of them", examples=["8"]
    )


def hand_tag(value: Any) -> str:
    """Which of the three forms a value has; a block with a list in it is one of layers."""
    if isinstance(value, Layers):
        return LAYERS
    if not isinstance(value, dict):
        return HEIGHT
    layered = {"layers", "pieces_each"} & set(value) or any(isinstance(one, list) for one in value.values())
    return LAYERS if layered else BY_PRODUCT


def _no_list(value: object) -> object:
    if value == {}:
        raise plain_error("expected a height, found {}", "by product such as {carton: rack.low, case: rack.top}")
    if isinstance(value, list):
        hint = "in turn such as {layers: [pallet.top, pallet.bottom], pieces_each: 8}"
        raise plain_error(f"expected a height, found {shown(value)}", hint)
    return value


Hand = Annotated[
    Annotated[HandHeight, Tag(HEIGHT)]
    | Annotated[Layers, Tag(LAYERS)]
    | Annotated[dict[NameText, HandHeight], Tag(BY_PRODUCT)],
    Discriminator(hand_tag),
    BeforeValidator(_no_list),
]


class TaskBlock(Block):
    """What every task may say."""

    load_kg: Load | None = Field(
        None,
        alias="load",
        description="mass in both hands together; 0 kg: nothing heavy; absent: scores are intervals",
        examples=["6 kg"],
    )
    loaded: Loaded | None = Field(
        None,
        description="when the load is in the hands; absent: all the time",
        examples=["{from: grasp, to: release}"],
    )
    handling: Handling | None = Field(
        None,
        description="what no posture tells: grip, force, forearm, support",
        examples=["{grip: fair, force: repeated}"],
    )
    repeat: Whole = Field(
        1, ge=1, le=10_000, description="how often it is done, each with a draw of its own", examples=[3]
    )
    automatic: Automatic = Field(
        False,
        description="true: the station does it alone, no worker; attended: the station's time, and a worker stays",
        examples=[True],
    )
    team: Whole = Field(
        1,
        ge=1,
        le=100,
        description="workers at once; none is sent before so many are free, the slowest ends it",
        examples=[2],
    )
    needs: Needs = Field({}, description="so many of each tool, from when its worker sets out until the task is done")
    hold: Hold | None = Field(
        None,
        description="a tool in the hands from one moment of each performance to another",
        examples=["{tool: torque_gun, from: grasp, to: release}"],
    )
    interruption: RULES | None = Field(
        None,
        description="how it is left at breaks and at the end of the shift, whatever the shift says (at_break, at_end)",
        examples=["finish"],
    )
    per: Literal["unit", "lot"] = Field("unit", description="done for each unit of a lot, or once for the lot")

    @property
    def words(self) -> str:
        """Where the time comes from, in a few words, e.g. ``lognormal, mean 20 s, cv 0.25``."""
        raise NotImplementedError

    @model_validator(mode="after")
    def _hands(self) -> TaskBlock:
        """Who works, and with what in his hands."""
        if self.team > 1 and self.automatic is True:
            raise plain_error(
                "nobody is needed where the station works alone", "write 'automatic: attended'", on="team"
            )
        if self.team > 1 and self.hold is not None:
            hint = "take 'needs' for what the team works with, or make it a task of its own"
            raise plain_error("a tool is held by one worker, and this task is done by a team", hint, on="hold")
        if self.interruption is not None and self.automatic is True:
            found = "no worker leaves what the station does alone"
            raise plain_error(found, "remove 'interruption'", on="interruption")
        if self.hold is not None and self.automatic is True:
            hint = "take 'needs' for what the run takes as a whole"
            raise plain_error("nobody holds a tool where the station works alone", hint, on="hold")
        if self.automatic == ATTENDED and any(hasattr(self, kind) for kind in ("emulator", "motions", "plugin")):
            hint = "give the station's time, such as 'fixed: 40 s'"
            raise plain_error("a movement takes its worker's time, not the station's", hint, on="automatic")
        return self


class Emulated(TaskBlock):
    """Duration and posture from a motion emulator: ``emulator: library/task``."""

    emulator: str = Field(description="library/task", examples=["moves/deep_squat"])
    hands: dict[str, Hand] = Field(
        {},
        description="by a mark of the movement, where the middle of both hands is then: a level of a place, or a "
        "height above the floor; at one mark by product, or in layers that are used up in turn; body and time follow",
        examples=["{grasp: rack.low, release: bench.surface}", "{grasp: {carton: rack.low, case: rack.top}}"],
    )

    @model_validator(mode="after")
    def _one_varies(self) -> Emulated:
        """Who works alone, and with nothing held, can go to one height or another."""
        varies = [mark for mark, said in self.hands.items() if isinstance(said, Layers | dict)]
        if len(varies) > 1:
            found = f"heights change at {varies[0]!r} and at {varies[1]!r}"
            raise plain_error(found, "let them change at one mark of a task", on="hands")
        if not varies:
            return self
        said = {"team": self.team > 1, "hold": self.hold is not None, "automatic": bool(self.automatic)}
        for key in (key for key, is_said in said.items() if is_said):
            hint = f"remove {key!r}, or take one height"
            raise plain_error(f"heights that change go with one worker alone, and here is {key!r}", hint, on="hands")
        return self

    @property
    def varies(self) -> str | None:
        """The mark at which heights change with the product or the layer; None: at none."""
        return next((mark for mark, said in self.hands.items() if isinstance(said, Layers | dict)), None)

    @property
    def in_turn(self) -> bool:
        """Whether they change with the layer, not with the product."""
        return self.varies is not None and isinstance(self.hands[self.varies], Layers)

    @property
    def heights(self) -> list[float | tuple[str, str]]:
        """Those that change: of the layers in turn, or of the products; empty where none do."""
        said: Any = {} if self.varies is None else self.hands[self.varies]
        return list(said.layers if self.in_turn else said.values())

    @property
    def library(self) -> str:
        return self.emulator.partition("/")[0]

    @property
    def library_task(self) -> str:
        return self.emulator.partition("/")[2]

    @property
    def words(self) -> str:
        return f"emulator {self.emulator}"


class Plugged(TaskBlock):
    """Duration from an emulator that a plug-in brings: ``plugin: NAME`` and what is said to it, ``with: {...}``."""

    plugin: str = Field(description="an installed emulator", examples=["mtm1_get_and_place"])
    said: dict[str, Any] = Field(
        {},
        alias="with",
        description="the emulator's parameters, quantities with their units",
        examples=["{reach: 40 cm}"],
    )

    @property
    def words(self) -> str:
        said = ", ".join(f"{key} {value}" for key, value in self.said.items())
        return f"plug-in {self.plugin}" + (f" with {said}" if said else "")


class Fixed(TaskBlock):
    """Always this long."""

    fixed_s: Seconds = Field(alias="fixed", description="always this long", examples=["20 s"])

    @property
    def mean_s(self) -> float:
        return self.fixed_s

    @property
    def words(self) -> str:
        return f"fixed, {self.fixed_s:g} s"


class Recorded(TaskBlock):
    """Durations in seconds from a column of a CSV file.

    resample: drawn again; trace: replayed in order; smooth: from their smoothed distribution.
    """

    recorded: str = Field(description="a CSV file in the scenario's folder", examples=["times.csv"])
    column: str | None = Field(None, description="needed where the file has several columns", examples=["seconds"])
    by: Literal["resample", "trace", "smooth"] = Field(
        "resample", description="drawn again; in the file's order; or drawn from the smoothed distribution"
    )

    @property
    def words(self) -> str:
        return f"recorded, {self.recorded} ({self.by})"

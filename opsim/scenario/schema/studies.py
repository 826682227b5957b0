"""What differences between people cost: what is asked.

Which station stands where: what is asked.

The best of several variants, with a promise: what is asked.

``studies:``: what is asked of a scenario beside running it; each verb of the command line has a block here.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated, Literal

from pydantic import AfterValidator, BeforeValidator, Field, model_validator

from opsim.kpi.catalogue import read_asked
from opsim.kpi.targets import check_indifference, read_limit, read_target
from opsim.problems import shown
from opsim.scenario.fields import Name, NameText, Whole, plain_error, read_any_moved, read_moved
from opsim.scenario.schema.run import OnOff
from opsim.scenario.schema.sweep import Factors, FigureText, Sweep, WayFigureText
from opsim.scenario.tree import Block

MOST_WORKFORCES, MOST_REPLICATIONS, MOST_MORE = 100_000, 100_000, 20


def _at_least_two(of: str, why: str) -> BeforeValidator:
    def read(value: object) -> object:
        if isinstance(value, int) and not isinstance(value, bool) and value < 2:
            raise plain_error(f"at least 2 {of} are needed, found {shown(value)}", why)
        return value

    return BeforeValidator(read)


_WORKFORCES = _at_least_two("workforces", "one team of people cannot tell how much it matters who is hired")
_REPLICATIONS = _at_least_two(
    "replications of each workforce",
    "with one, who the people are and the luck of the day cannot be told apart",
)


def _known_target(value: object) -> object:
    if not isinstance(value, str):
        raise plain_error(
            f"expected a target, found {shown(value)}", "such as 'throughput_per_h >= 60', or '480 a day'"
        )
    try:
        read_target(value)
    except ValueError as error:
        message, _, hint = str(error).partition("; ")
        raise plain_error(message, hint) from None
    return value


def _off_is_nothing(value: object) -> object:
    """``buy_back: off`` asks for none; YAML 1.1 writers make false of off."""
    return None if value == "off" or value is False else value


Target = Annotated[str, BeforeValidator(_known_target)]


class BuyBack(Block):
    """What may buy back that people differ: more people, or more skills for those who are there."""

    most_workers: Whole = Field(
        2, ge=0, le=MOST_MORE, description="so many people more at most; 0: none is tried", examples=[3]
    )
    most_skills: Whole = Field(
        6, ge=0, le=MOST_MORE, description="so many steps of cross-training at most; 0: none is tried", examples=[4]
    )
    like: list[NameText] | None = Field(
        None,
        description="whom the added people are like; absent: each worker in turn, one of those who are alike",
        examples=["[ana]"],
    )


class Labour(Block):
    """What differences between people cost, and what buys it back."""

    workforces: Annotated[Whole, _WORKFORCES] = Field(
        40, le=MOST_WORKFORCES, description="how many other sets of people are hired", examples=[40]
    )
    replications: Annotated[Whole, _REPLICATIONS] = Field(
        4, le=MOST_REPLICATIONS, description="days of each workforce, each with other luck", examples=[4]
    )
    design: Literal["crossed", "nested"] = Field(
        "crossed",
        description="crossed: all workforces have the same days; nested: each has days of its own",
    )
    figures: list[FigureText] = Field(
        [],
        description="what the budget is made of beside throughput_per_h and work_in_progress; absent: the exposure "
        "figures among the outputs",
        examples=["[fatigue_mean, rula_mean]"],
    )
    budget: OnOff = Field(True, description="off: what each source of variability costs is not asked", examples=["off"])
    alone: OnOff = Field(False, description="on: each source is also tried as the only one", examples=["on"])
    target: Target | None = Field(
        None,
        description="what a day has to reach",
        examples=["480 a day", "throughput_per_h >= 60"],
    )
    buy_back: Annotated[BuyBack | None, BeforeValidator(_off_is_nothing)] = Field(
        BuyBack.model_validate({}),
        description="what may buy the loss back; off: not asked",
        examples=["{most_workers: 3}", "off"],
    )


MOST_PROPOSALS = 50
FEWEST_REPLICATIONS = 2
"""That say anything of a difference."""


def _one_or_more(value: object) -> object:
    return [value] if isinstance(value, str) else list(value) if isinstance(value, tuple) else value


def _readable(read: Callable[[str], object]) -> AfterValidator:
    """Each text is a change that can be read; which names there are is asked of the scenario later."""

    def check(texts: list[str]) -> list[str]:
        for number, text in enumerate(texts):
            try:
                read(text)
            except ValueError as error:
                message, _, hint = str(error).partition("; ")
                raise plain_error(message, hint, on=number) from None
        return texts

    return AfterValidator(check)


def _once(names: list[str]) -> list[str]:
    twice = [number for number, name in enumerate(names) if name in names[:number]]
    if twice:
        raise plain_error(f"{names[twice[0]]!r} is named twice", on=twice[0])
    return names


Names = Annotated[list[NameText], BeforeValidator(_one_or_more), AfterValidator(_once)]
AnyChange = Annotated[list[str], BeforeValidator(_one_or_more), Field(min_length=1), _readable(read_any_moved)]


class LayoutStudy(Block):
    """Which station stands where."""

    fixed: Names = Field([], description="stations that stay where they are", examples=["[saw, press]"])
    places: Names | None = Field(
        None,
        min_length=1,
        description="the only places where the other stations may be put; absent: where they stand now, and the places "
        "of the layout that nobody uses (with distance: paths only where stations stand now)",
        examples=["[bay_1, bay_2, bay_3]"],
    )
    proposals: Whole = Field(5, ge=0, le=MOST_PROPOSALS, description="how many are made and simulated", examples=[5])
    replications: Whole | None = Field(
        None,
        ge=FEWEST_REPLICATIONS,
        description="of each layout, and as many fresh ones of the one taken and of the present one; absent: those of "
        "run, but at least 10",
        examples=[20],
    )
    best: WayFigureText = Field(
        "throughput_per_h", description="by which figure the best is taken: a KPI, or 'less KPI'", examples=["walked_m"]
    )
    exposure: WayFigureText | None = Field(
        None,
        description="the second criterion: what bodies go through, of the worker who has most of it; absent: the first "
        "such figure among the outputs",
        examples=["rula_from_5_min_per_h"],
    )
    move: Annotated[list[str], BeforeValidator(_one_or_more), _readable(lambda text: read_moved("move", text))] = Field(
        [], description="what if a place were elsewhere", examples=["['bench=6 m, 1 m']"]
    )
    swap: Annotated[list[str], BeforeValidator(_one_or_more), _readable(lambda text: read_moved("swap", text))] = Field(
        [], description="what if two stations changed places", examples=["['saw,drill']"]
    )
    place: Annotated[list[str], BeforeValidator(_one_or_more), _readable(lambda text: read_moved("place", text))] = (
        Field([], description="what if a station stood at another place", examples=["['drill=spare_2']"])
    )
    add: Annotated[list[str], BeforeValidator(_one_or_more), _readable(lambda text: read_moved("add", text))] = Field(
        [], description="what if there were one more", examples=["['second_drill=like drill at spare_1']"]
    )
    what_ifs: dict[Name, AnyChange] = Field(
        {},
        description="layouts by name: changes, one after the other",
        examples=["{near: ['swap saw,drill', 'place pack=bay_7']}"],
    )


Procedure = Literal["kn", "rinott", "dudewicz-dalal", "ocba"]
MOST = 1_000_000


def _amount(value: object) -> object:
    if isinstance(value, bool) or not isinstance(value, int | float | str):
        raise plain_error(f"expected a difference too small to matter, found {shown(value)}", "such as 2 or '1 %'")
    return value


def _limit(value: object) -> object:
    if not isinstance(value, str):
        raise plain_error(f"expected a limit, found {shown(value)}", "such as rula_from_5_min_per_h/worst <= 10")
    try:
        read_limit(value)
    except ValueError as error:
        message, _, hint = str(error).partition("; ")
        raise plain_error(message, hint) from None
    return value


Indifference = Annotated[int | float | str, BeforeValidator(_amount)]
LimitText = Annotated[str, BeforeValidator(_limit)]


class Select(Block):
    """The best of several variants, with a promise."""

    figure: WayFigureText = Field(
        "throughput_per_h",
        description="what is to be best; where nobody agrees which way, 'more' or 'less' stands before it",
        examples=["throughput_per_h", "less walked_m/ana"],
    )
    indifference: Indifference | None = Field(
        None,
        description="a difference too small to matter, with the figure's unit where it has one; 1 %: of the base",
        examples=[2, "1 %", "20 s"],
    )
    confidence: float = Field(
        0.95, gt=0, lt=1, description="the chance at least that the choice is right", examples=[0.99]
    )
    procedure: Procedure = Field(
        "kn",
        description="kn: side by side, whoever is clearly beaten is out; rinott, dudewicz-dalal: two stages with "
        "random numbers of each variant's own; ocba: replications where they tell most, nothing promised beforehand",
    )
    subject_to: list[LimitText] = Field(
        [],
        max_length=10,
        description="limits that the chosen one has to keep, with how near is near enough behind +- (2 % otherwise)",
        examples=["[rula_from_5_min_per_h/worst <= 10 +- 0.5]"],
    )
    variants: list[NameText] | None = Field(
        None, min_length=1, description="of the file's variants, which; absent: all", examples=["[base, near]"]
    )
    vary: Factors | None = None
    search: bool = Field(
        False, description="true: an optimiser looks for good values of what is varied; false: every combination"
    )
    trials: Whole | None = Field(
        None, ge=2, le=100_000, description="of a search: points tried; 60 where nobody says", examples=[60]
    )
    trial_replications: Whole = Field(
        3, ge=1, le=10_000, description="of a search: replications of each point tried", examples=[3]
    )
    finalists: Whole = Field(
        5, ge=1, le=100, description="of a search: how many of the best points go on", examples=[5]
    )
    base: Name | None = Field(
        None,
        description="the variant that the chosen one is compared with; absent: the first of the file",
        examples=["base"],
    )
    replications: Whole = Field(
        40,
        ge=2,
        le=MOST,
        description="fresh ones, on which the chosen one is looked at again beside the base",
        examples=[40],
    )
    first_replications: Whole | None = Field(
        None,
        ge=5,
        le=MOST,
        description="of each variant, from which its spread is known; 10 for kn and ocba, else 20",
        examples=[10],
    )
    most_replications: Whole | None = Field(
        None,
        ge=5,
        le=MOST,
        description="of each variant at most, without the fresh ones, 1000 where nobody says; of ocba all together, "
        "100 of each variant",
        examples=[1000],
    )
    batch: Whole = Field(
        10, ge=1, le=10_000, description="how many are run of each variant left before the next look", examples=[10]
    )

    @model_validator(mode="after")
    def _fits_together(self) -> Select:
        if self.indifference is None:
            hint = "such as indifference: 2, or '1 %' of the base"
            raise plain_error("nothing says which difference is too small to matter", hint, on="indifference")
        try:
            check_indifference(self.indifference, read_asked(self.figure).kpi)
        except ValueError as error:
            message, _, hint = str(error).partition("; ")
            raise plain_error(message, hint, on="indifference") from None
        if (self.search or self.trials) and not self.vary:
            hint = "add e.g. vary: {stations.saw.buffer: [1, 2, 4]}"
            raise plain_error("a search needs to know what it may vary", hint, on="search")
        if self.vary and self.variants:
            raise plain_error("either the file's variants or what is varied", "keep one of both", on="variants")
        if self.subject_to and self.procedure != "kn":
            hint = "take kn, or leave the limits out"
            raise plain_error(f"the procedure {self.procedure} knows no limits", hint, on="subject_to")
        if self.most_replications and self.first_replications and self.first_replications > self.most_replications:
            found = f"more first replications ({self.first_replications}) than there may be at most"
            raise plain_error(found, f"at most {self.most_replications}", on="first_replications")
        return self

    @property
    def first(self) -> int:
        """Replications of the first stage."""
        return self.first_replications or (10 if self.procedure in ("kn", "ocba") else 20)


class Studies(Block):
    """What is asked of a scenario beside running it. It decides nothing of what happens on the floor."""

    sweep: Sweep | None = Field(None, description="``opsim sweep``: many points of some factors")
    select: Select | None = Field(None, description="``opsim select``: the best of several variants")
    labour: Labour | None = Field(None, description="``opsim labour``: what differences between people cost")
    layout: LayoutStudy | None = Field(None, description="``opsim layout``: which station stands where")

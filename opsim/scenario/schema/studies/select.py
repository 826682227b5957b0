"""The best of several variants, with a promise: what is asked."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BeforeValidator, Field, model_validator

from opsim.kpi.amounts import check_indifference, read_limit
from opsim.kpi.better import read_asked
from opsim.problems import shown
from opsim.scenario.fields import Name, NameText, Whole, plain_error
from opsim.scenario.schema.base import Block
from opsim.scenario.schema.studies.factors import Factors
from opsim.scenario.schema.studies.figures import WayFigureText

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

"""Many points of some factors: what is asked."""

from __future__ import annotations

from typing import Any, Literal

from pydantic import Field, model_validator

from opsim.scenario.fields import Whole, plain_error
from opsim.scenario.schema.base import Block
from opsim.scenario.schema.studies.factors import Factors, Range
from opsim.scenario.schema.studies.figures import FigureText

Design = Literal["grid", "list", "one_at_a_time", "latin_hypercube", "sobol", "sobol_indices", "morris"]
FILLING = ("latin_hypercube", "sobol")
"""Designs that spread their points over the whole room."""
SENSITIVITY = ("sobol_indices", "morris")
COUNTED = (*FILLING, *SENSITIVITY)
"""Designs of as many points as are asked for."""


class Sweep(Block):
    """Many points of some factors."""

    vary: Factors | None = None
    design: Design | None = Field(
        None,
        description="grid: every combination; list: the points given; one_at_a_time: each factor's ends alone; "
        "latin_hypercube, sobol: points spread over the ranges; sobol_indices, morris: which factor matters, alone "
        "and with others (by SALib). By default list where points are given, grid where every factor is a list or has "
        "levels, else latin_hypercube",
        examples=["grid"],
    )
    points: Whole | list[dict[str, Any]] | None = Field(
        None,
        description="how many points a latin_hypercube or sobol has; how many base points sobol_indices and how many "
        "paths morris has; or a list of points, each a block of paths and values",
        examples=[64],
    )
    levels: Whole | None = Field(
        None, ge=2, le=1000, description="of a grid: how many values every range has", examples=[3]
    )
    replications: Whole | None = Field(
        None,
        ge=1,
        le=1_000_000,
        description="of each point, the same luck in all; by default as the scenario runs",
        examples=[20],
    )
    figures: list[FigureText] | None = Field(
        None,
        min_length=1,
        description="figures that are told, such as 'throughput_per_h' or 'less walked_m/ana'; by default the outputs",
        examples=[["throughput_per_h"]],
    )

    @property
    def chosen(self) -> Design:
        """The design that is meant."""
        if self.design is not None:
            return self.design
        if isinstance(self.points, list):
            return "list"
        ranges = [one for one in (self.vary or {}).values() if isinstance(one, Range)]
        counted = self.points is not None or any(one.levels is None and self.levels is None for one in ranges)
        return "latin_hypercube" if counted else "grid"

    @model_validator(mode="after")
    def _fits_together(self) -> Sweep:
        design, points = self.chosen, self.points
        if design == "list":
            self._check_list()
        elif not self.vary:
            raise plain_error("nothing says what is varied", "add e.g. vary: {release.every: [40 s, 50 s]}")
        elif isinstance(points, list):
            raise plain_error(f"a list of points is no {design}", "leave the design out, or give a number", on="points")
        elif points is not None and not 2 <= points <= 1_000_000:
            raise plain_error(f"must be from 2 to 1000000 points, found {points}", on="points")
        if design == "grid":
            self._check_levels()
        return self

    def _check_list(self) -> None:
        if self.vary:
            raise plain_error("points are given one by one, so nothing is left to vary", "keep one of both", on="vary")
        if not isinstance(self.points, list) or not self.points or not all(self.points):
            found = "the design list needs its points, each a block of paths and values"
            raise plain_error(found, "such as points: [{release.every: 40 s}, {release.every: 50 s}]", on="points")

    def _check_levels(self) -> None:
        for path, one in (self.vary or {}).items():
            if isinstance(one, Range) and one.levels is None and self.levels is None:
                found = f"a grid needs to know how many values the range of {path} has"
                raise plain_error(found, "add e.g. levels: 3, or take the design latin_hypercube", on="vary")

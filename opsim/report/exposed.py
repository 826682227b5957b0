"""What bodies go through: minutes at high scores, limits, the day over the clock, and the worst postures."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from opsim.report.bodies import bodies_of
from opsim.report.days import left_out
from opsim.report.exposure import exposure_blocks, has_regions
from opsim.report.limit_sentences import limit_sentences
from opsim.report.material import Material
from opsim.report.section import Block, Bullets, Card, Heading, Panels, Picture, Section, Words

WORST = (
    "The worst of each task in the first replication, from the side of the arm that scores higher and from the front. "
    "The warmer a part of the body, the more points of RULA it brings in; a box is what the hands hold. Sub-scores of "
    "the method stand beside."
)
CARD_PX = 430
"""The least width of a posture's card."""


def section(material: Material) -> Section | None:
    """None where nothing of it was asked for."""
    rows = material.summary["kpis"]
    limits, went = limit_sentences(rows), bodies_of(material)
    blocks = exposure_blocks(rows, material.summary["confidence"])
    if limits:
        blocks += [Heading("Limits of lifting, holding and rest"), Bullets(limits)]
    if went is not None:
        blocks += [*_day(went, regions=not has_regions(rows)), *_postures(went["postures"])]
    return Section("exposure", "What bodies go through", blocks, "Exposure") if blocks else None


def _day(went: Mapping[str, Any], *, regions: bool) -> list[Block]:
    """regions : whether it is to be said here from which of them high scores come"""
    cut = ", its first 24 hours after the warm-up" if went["cut"] else ""
    every = "minute by minute" if went["minutes"] == 1 else f"every {went['minutes']} minutes"
    text = (
        f"The first replication{cut}, {every}: the height of a colour is its share of the time. White is waiting, and "
        "walking that was not looked at; breaks are hatched; a dark line marks a shift."
    )
    picture = Picture(went["picture"], went["alt"], caption=left_out(went["more"]), legend=went["legend"])
    said = map(Words, went["regions"] if regions else ())
    return [Heading("Over the clock"), *said, Words(text), picture]


def _postures(postures: list[dict[str, Any]]) -> list[Block]:
    cards = [
        Card(one["title"], one["scores"], one["when"], one["pictures"], one["parts"], one["drives"]) for one in postures
    ]
    return [Heading("The worst postures"), Words(WORST), Panels(cards, least_px=CARD_PX)] if cards else []

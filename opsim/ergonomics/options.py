"""How postures are scored: thresholds and the forks that published methods leave open, by name.

What scores ask for and nobody sees or says, which counts as absent; and how the methods were read.
"""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from math import isfinite
from typing import Any

from opsim.problems import did_you_mean, shown


@dataclass(frozen=True, slots=True)
class Thresholds:
    """Angles in degrees (lengths in metres) that papers give as pictures or words only. Source, default: design.

    twist, side        : from which trunk or neck count as twisted, as bent sideways; looked at over 5 to 20 where
                         ``spread`` asks how much that matters: then scores are intervals over it
    abducted           : from which an upper arm counts as abducted
    arm_sideways       : abduction beyond which flexion says little, as the arm lies in its axis: there the elevation,
                         which is then near 90 degrees, is the angle that is scored (3 to shoulder height, 4 above)
    trunk_upright      : RULA's and REBA's "0 degrees" of a trunk that stands upright
    wrist_straight     : RULA's "0 degrees" of a wrist
    neck_extended      : so far behind its neutral a neck is not yet extended: the neutral is a median, and without
                         leeway every other look straight ahead would have RULA's worst neck
    across_m           : from which a hand counts as across the midline of the body
    outside_m          : from which a hand counts as out to the side of its own shoulder, by turning the forearm (0.25
                         is the forearm of an adult turned 45 degrees): where the upper arm is abducted, that has scored
    owas_back, owas_twist : bent back; twisted or bent sideways
    owas_knee          : a knee's included angle below which it is bent
    """

    twist: float = 10.0
    side: float = 10.0
    abducted: float = 30.0
    arm_sideways: float = 80.0
    trunk_upright: float = 5.0
    wrist_straight: float = 3.0
    neck_extended: float = 5.0
    across_m: float = 0.05
    outside_m: float = 0.25
    owas_back: float = 20.0
    owas_twist: float = 20.0
    owas_knee: float = 150.0
    spread: bool = False


@dataclass(frozen=True, slots=True)
class Options:
    """rate_hz : postures looked at a second

    arm_reference  : ``trunk`` or ``gravity``: what RULA's and REBA's angles of the upper arm are taken against
    rula_table_a   : ``published`` or ``worksheet2000``
    rula_force     : ``paper`` or ``worksheet`` (more than 10 kg is always 3)
    owas_disputed  : codes whose alternative action category is taken, such as ("3373",)
    waiting        : ``unmeasured``, or ``upright``: standing with hanging arms, which nobody has seen
    """

    rate_hz: float = 12.0
    arm_reference: str = "trunk"
    rula_table_a: str = "published"
    rula_force: str = "paper"
    owas_disputed: tuple[str, ...] = ()
    waiting: str = "unmeasured"
    thresholds: Thresholds = field(default_factory=Thresholds)


USUAL = Options()
PAPER = Thresholds(trunk_upright=0.0, wrist_straight=0.0, neck_extended=0.0)
"""Thresholds as the papers print them: for angles that somebody has read off, not for those of a moving skeleton."""

RANGES: dict[str, tuple[float, float]] = {
    "rate_hz": (1.0, 60.0),
    "twist": (1.0, 90.0),
    "side": (1.0, 90.0),
    "abducted": (1.0, 90.0),
    "arm_sideways": (60.0, 90.0),
    "trunk_upright": (0.0, 20.0),
    "wrist_straight": (0.0, 15.0),
    "neck_extended": (0.0, 45.0),
    "across_m": (0.0, 0.5),
    "outside_m": (0.0, 1.0),
    "owas_back": (1.0, 90.0),
    "owas_twist": (1.0, 90.0),
    "owas_knee": (90.0, 179.0),
}
"""Least and most of each number; RULA's next edges are 20 degrees of a trunk, 15 of a wrist: beyond, out of order."""
UNITS = {"rate_hz": "a second", "across_m": "m", "outside_m": "m"}
"""What is not in degrees."""
DISPUTED = ("3373", "4132")
"""Codes of OWAS whose action category transcriptions differ in."""
CHOICES: dict[str, tuple[str, ...]] = {
    "arm_reference": ("trunk", "gravity"),
    "rula_table_a": ("published", "worksheet2000"),
    "rula_force": ("paper", "worksheet"),
    "waiting": ("unmeasured", "upright"),
}
"""The words of each fork."""


def checked(options: Options) -> Options:
    """The options themselves. Raises one ValueError that lists all their mistakes, a line each."""
    mistakes = [
        *(found for name in CHOICES for found in _not_a_choice(name, getattr(options, name))),
        *(
            f"owas_disputed: no disputed code {shown(code)}; {did_you_mean(code, DISPUTED)}"
            for code in options.owas_disputed
            if code not in DISPUTED
        ),
        *_out_of_range("rate_hz", options.rate_hz),
        *(
            f"thresholds.{found}"
            for one in fields(Thresholds)
            if one.name in RANGES
            for found in _out_of_range(one.name, getattr(options.thresholds, one.name))
        ),
    ]
    if not isinstance(options.thresholds.spread, bool):
        mistakes.append(f"thresholds.spread: found {shown(options.thresholds.spread)}, expected true or false")
    if mistakes:
        raise ValueError("\n".join(mistakes))
    return options


def _not_a_choice(name: str, word: Any) -> list[str]:
    known = CHOICES[name]
    return [] if word in known else [f"{name}: no {shown(word)}; {did_you_mean(word, known)}"]


def _out_of_range(name: str, value: Any) -> list[str]:
    low, high = RANGES[name]
    number = isinstance(value, int | float) and not isinstance(value, bool) and isfinite(value)
    if number and low <= value <= high:
        return []
    return [f"{name}: found {shown(value)}, expected {low:g} to {high:g} {UNITS.get(name, 'degrees')}"]


NOT_SEEN = (
    "RULA, REBA: the neck is taken as not twisted: a head is one joint, which does not say where somebody looks",
    "RULA, REBA: how far a wrist is bent is the angle between forearm and hand in any direction: bent towards thumb or "
    "little finger alone, by more than 15 degrees, it scores more by RULA than by the paper (3, not 2); the point that "
    "the papers add for being bent so is never added",
    "RULA, REBA: the shoulder is taken as not raised",
    "REBA: the upper arm is taken as not rotated, and not as helped by gravity",
    "REBA: the wrist is taken as not twisted (how far the forearm is, which RULA asks for, can be said)",
    "OWAS: nobody kneels: bodies on their knees are taken as squatting, on one knee or both as their legs are bent",
)
"""Sentences for the assumption sheet: what no skeleton shows."""
RULES = (
    "RULA: a trunk bent backward counts as one bent forward by as much: the paper draws none",
    "RULA: whoever sits is well supported where his trunk is upright or leans back",
    "RULA, REBA: where sitting is not said, whoever has both knees straight does not sit",
    "REBA: the knees of somebody who walks or sits do not count",
    "OWAS: a body on both feet with one knee bent, which the method has no code for, is taken as both ways",
)
"""Sentences for the assumption sheet: how the methods were read where they leave it open."""

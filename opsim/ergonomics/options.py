"""How postures are scored: thresholds and the forks that published methods leave open, by name."""

from __future__ import annotations

from dataclasses import dataclass, field


@dataclass(frozen=True, slots=True)
class Thresholds:
    """Angles in degrees that papers give as pictures or words only. Source and default of each: design.

    twist, side        : from which trunk or neck count as twisted, as bent sideways; looked at over 5 to 20 where
                         ``spread`` asks how much that matters: then scores are intervals over it
    abducted           : from which an upper arm counts as abducted
    trunk_upright      : RULA's and REBA's "0 degrees" of a trunk that stands upright
    wrist_straight     : RULA's "0 degrees" of a wrist
    owas_back, owas_twist : bent back; twisted or bent sideways
    owas_knee          : a knee's included angle below which it is bent
    """

    twist: float = 10.0
    side: float = 10.0
    abducted: float = 30.0
    trunk_upright: float = 5.0
    wrist_straight: float = 3.0
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

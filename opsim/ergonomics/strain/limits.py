"""Limits of single angles: ISO 11226 for postures that are held, EN 1005-4 for postures and movements at machines.

Both standards are not free. Their numbers here are as their secondary literature gives them (for instance Delleman,
Haslegrave & Chaffin 2004, Working postures and movements, CRC Press) and as two public implementations have them;
whoever judges by them should check them against the standard itself. Zones that ask for support, stability or
recovery that nobody told are taken as not given.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

ACCEPTABLE, CONDITIONAL, NOT_RECOMMENDED = range(3)
WORDS = ("acceptable", "conditional", "not recommended")


@dataclass(frozen=True, slots=True)
class Held:
    """How long one angle may be held; degrees and seconds. Between free and most, linear from ``longest_s`` down.

    least : below it nothing is recommended (without support)
    free  : up to it any time will do; most: beyond it no time will do
    longest_s, shortest_s : the longest acceptable holding time just beyond ``free``, and at ``most``
    """

    least: float
    free: float
    most: float
    longest_s: float
    shortest_s: float


@dataclass(frozen=True, slots=True)
class Iso11226:
    """ISO 11226:2000, Ergonomics, Evaluation of static working postures (and Cor 1:2006).

    trunk : inclination against upright, table 1 and figure 2: 20 to 60 degrees, 4 min down to 1 min
    arm   : elevation of the upper arm without support, table 4 and figure 4: 20 to 60 degrees, 3 min down to 1 min
    head  : inclination of the head against upright, table 3 and figure 3: 25 to 85 degrees, 8 min down to 1 min
    neck  : flexion of the neck, head against trunk, table 3: 0 to 25 degrees and nothing else

    Backward nothing is recommended without support; the standard says beyond 0 degrees, 5 allow for how a neutral is
    measured (source: design). Asymmetry, which it says should not be visible, is judged by EN 1005-4.
    """

    trunk: Held = Held(-5.0, 20.0, 60.0, 240.0, 60.0)
    left_arm: Held = Held(-5.0, 20.0, 60.0, 180.0, 60.0)
    right_arm: Held = Held(-5.0, 20.0, 60.0, 180.0, 60.0)
    head: Held = Held(-5.0, 25.0, 85.0, 480.0, 60.0)
    neck: Held = Held(-5.0, 25.0, 25.0, 0.0, 0.0)


ISO_11226 = Iso11226()


def holding_time_s(angle_deg: np.ndarray | float, held: Held) -> np.ndarray:
    """How long an angle may be held at most: inf where any time will do, 0 where none will; nan for nan."""
    angle = np.asarray(angle_deg, float)
    share = (angle - held.free) / max(held.most - held.free, 1e-12)
    between = held.longest_s + (held.shortest_s - held.longest_s) * np.clip(share, 0.0, 1.0)
    time = np.where(angle <= held.free, np.inf, np.where(angle <= held.most, between, 0.0))
    return np.where(np.isnan(angle), np.nan, np.where(angle < held.least, 0.0, time))


def judged_static(angle_deg: np.ndarray | float, held_s: np.ndarray | float, held: Held) -> np.ndarray:
    """One of ACCEPTABLE, CONDITIONAL (a time limit that is kept), NOT_RECOMMENDED for an angle held so long; int8."""
    limit_s = holding_time_s(angle_deg, held)
    within = np.where(np.isinf(limit_s), ACCEPTABLE, CONDITIONAL)
    return np.where(np.asarray(held_s, float) <= limit_s, within, NOT_RECOMMENDED).astype(np.int8)


@dataclass(frozen=True, slots=True)
class Zones:
    """EN 1005-4's zones of one angle, degrees: below ``low`` is the backward zone, up to ``free`` zone 1, up to ``far``
    zone 2, beyond it zone 3.

    Each of the four has its verdicts for (static, moved rarely, moved often); rarely is below ``often_per_min``.
    leeway_deg : so far below ``low`` is zone 1 still, for how a neutral is measured: who stands upright leans back by a
        degree as often as forward. The standard has none. Source: design, as ``least`` of ISO 11226 here
    """

    low: float
    free: float
    far: float
    backward: tuple[int, int, int]
    zone_2: tuple[int, int, int]
    zone_3: tuple[int, int, int]
    leeway_deg: float = 5.0

    @property
    def backward_from(self) -> float:
        """The backward zone lies below it."""
        return self.low - self.leeway_deg

    @property
    def verdicts(self) -> tuple[tuple[int, int, int], ...]:
        """Of the backward zone, zones 1, 2 and 3."""
        return self.backward, (ACCEPTABLE,) * 3, self.zone_2, self.zone_3


_NEVER_OFTEN = (NOT_RECOMMENDED, CONDITIONAL, NOT_RECOMMENDED)
_HELD_FOR_A_WHILE = (CONDITIONAL, ACCEPTABLE, NOT_RECOMMENDED)
STATIC, RARELY, OFTEN = range(3)


@dataclass(frozen=True, slots=True)
class En1005:
    """EN 1005-4:2005+A1:2008, Safety of machinery, Human physical performance, Part 4.

    trunk     : bending forward, table 1: 20 and 60 degrees; below 0 it is backward, only with support
    arm       : of the upper arm, forward or sideways, table 3: 20 and 60 degrees; behind the trunk as beyond 60
    sideways  : side bend and twist of the trunk, table 2: 10 degrees
    neck      : table 4 is of the line of sight, 0 to 40 degrees below level; flexion of the head against upright stands
                for it here, as no skeleton tells where eyes look. Source of that: design
    often_per_min : movements a minute from which one moves often (tables 1 to 4)
    arm_often_per_min : from here zone 2 of the arms is no longer conditional but not acceptable (table 3, note)
    static_s  : held for longer than this is static (3.4, as in ISO 11226)
    """

    trunk: Zones = Zones(0.0, 20.0, 60.0, (CONDITIONAL, CONDITIONAL, NOT_RECOMMENDED), _HELD_FOR_A_WHILE, _NEVER_OFTEN)
    arm: Zones = Zones(0.0, 20.0, 60.0, _NEVER_OFTEN, (CONDITIONAL, ACCEPTABLE, CONDITIONAL), _NEVER_OFTEN)
    sideways: Zones = Zones(-1e9, 10.0, 1e9, _NEVER_OFTEN, _NEVER_OFTEN, _NEVER_OFTEN)
    neck: Zones = Zones(0.0, 40.0, 1e9, _NEVER_OFTEN, _NEVER_OFTEN, _NEVER_OFTEN)
    often_per_min: float = 2.0
    arm_often_per_min: float = 10.0
    static_s: float = 4.0


EN_1005_4 = En1005()


def zone(angle_deg: np.ndarray | float, zones: Zones) -> np.ndarray:
    """0 the backward zone, 1, 2 or 3; nan is in no zone: -1. Edges belong to the better zone."""
    angle = np.asarray(angle_deg, float)
    found = np.where(angle < zones.backward_from, 0, 1 + (angle > zones.free) + (angle > zones.far))
    return np.where(np.isnan(angle), -1, found).astype(np.int8)


def judged_moving(angle_deg: np.ndarray | float, way: np.ndarray | int, zones: Zones) -> np.ndarray:
    """ACCEPTABLE, CONDITIONAL or NOT_RECOMMENDED for angles that are STATIC, or reached RARELY or OFTEN; -1 for nan."""
    table = np.array(zones.verdicts, np.int8)
    found = zone(angle_deg, zones)
    return np.where(found < 0, -1, table[np.maximum(found, 0), way]).astype(np.int8)

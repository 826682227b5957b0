"""What cleaning looks for, what it mends, and every number it goes by."""

from __future__ import annotations

from dataclasses import dataclass, fields
from difflib import get_close_matches
from math import isfinite
from typing import Any

POLICIES: dict[str, tuple[str, ...]] = {
    "swaps": ("mend", "tell", "off"),
    "jumps": ("mend", "tell", "off"),
    "slips": ("mend", "tell", "off"),
    "gaps": ("mend", "cut"),
    "bones": ("tell", "mend", "off"),
    "offsets": ("tell", "mend", "off"),
    "angles": ("tell", "mend", "off"),
    "low_pass": ("mend", "off"),
    "holds": ("tell", "off"),
    "heading": ("tell", "off"),
    "plausible": ("refuse", "off"),
}
"""Each step, and what may be asked of it; the first is what is done unless asked otherwise."""
MOST = {"s": 3600.0, "m": 100.0, "share": 100.0, "deg": 180.0, "hz": 1e5, "usual": 1e6}
"""No number may be larger, by the last part of its name (``jump_m_per_s`` is as free as a time)."""


@dataclass(frozen=True)
class CleaningSettings:
    """What is asked of each step (``POLICIES``), and its numbers. Raises ValueError with everything that is wrong.

    jump_m_per_s      : a joint's speed that changes by more from one frame to the next is a glitch: no body does that
    least_jump_m      : a step that surprises by less is none, whatever the joint usually does
    times_usual       : a jump is this many times the 90th percentile of what the joint does in the take
    longest_jump_s    : a joint that is away for longer has not jumped
    least_swap_m      : joints that are nearer to one another are not told apart
    bridged_gap_s     : a gap up to this is bridged by a cubic spline
    filled_gap_s      : a gap up to this is filled from three points that move with the joint, where they are seen
    rigid_m           : standard deviation of the distance up to which a point moves with the joint
    least_lost_s      : frames cut off that were seen, or lie between such, shorten a take if they last for longer
    kept_share        : a take of which less is without a longer gap is left out
    least_slip_share  : a bone that is longer or shorter by this share after a step shows which side of it is wrong
    bad_bone_share    : a take with a bone that leaves its median length by more (in more than 1 % of frames) is bad
    least_offset_deg  : a joint angle that differs by less from the person's other takes is not offset
    tolerance_deg     : this far beyond the limit an angle is still believed
    cut_off_hz        : of the low-pass; None: found for each joint by Winter's residual analysis
    noise_m           : a joint with less noise than this is smooth and is not filtered
    shortest_m, tallest_m : what a body can measure
    """

    plausible: str = "refuse"
    swaps: str = "mend"
    jumps: str = "mend"
    gaps: str = "mend"
    slips: str = "mend"
    bones: str = "tell"
    offsets: str = "tell"
    angles: str = "tell"
    low_pass: str = "mend"
    heading: str = "tell"
    holds: str = "tell"
    jump_m_per_s: float = 4.0
    least_jump_m: float = 0.05
    times_usual: float = 8.0
    longest_jump_s: float = 0.2
    least_swap_m: float = 0.05
    bridged_gap_s: float = 0.2
    filled_gap_s: float = 0.5
    rigid_m: float = 0.015
    least_lost_s: float = 0.1
    kept_share: float = 0.5
    least_slip_share: float = 0.04
    bad_bone_share: float = 0.5
    least_offset_deg: float = 10.0
    tolerance_deg: float = 15.0
    cut_off_hz: float | None = None
    noise_m: float = 0.001
    shortest_m: float = 0.6
    tallest_m: float = 2.6

    def __post_init__(self) -> None:
        wrong = [said for field in fields(self) if (said := _wrong(field.name, getattr(self, field.name)))]
        wrong += _contradictions({field.name: getattr(self, field.name) for field in fields(self)})
        if wrong:
            raise ValueError("\n".join(wrong))

    def frames(self, seconds: float, rate_hz: float) -> int:
        """How many frames a time is, a little more than whole ones not counted."""
        return int(seconds * rate_hz + 1e-9)


def settings_of(given: dict[str, Any]) -> CleaningSettings:
    """Settings from names and values. Raises ValueError for a name that is none, with the nearest."""
    known = [field.name for field in fields(CleaningSettings)]
    wrong = []
    for name in [name for name in given if name not in known]:
        near = get_close_matches(name, known, n=1)
        wrong.append(
            f"no setting {name!r}; " + (f"did you mean {near[0]!r}?" if near else f"known: {', '.join(known)}")
        )
    wrong += [said for name in given if name in known and (said := _wrong(name, given[name]))]
    wrong += _contradictions({field.name: field.default for field in fields(CleaningSettings)} | given)
    if wrong:
        raise ValueError("\n".join(wrong))
    return CleaningSettings(**given)


def beyond_rate(cut_off_hz: Any, rate_hz: float) -> list[str]:
    """What speaks against a cut-off for a recording of this many frames a second: nothing is left to filter there."""
    if cut_off_hz is None or _wrong("cut_off_hz", cut_off_hz) or cut_off_hz < rate_hz / 2:
        return []
    half = f"half of the recording's {rate_hz:g} frames a second"
    return [f"cut_off_hz: found {cut_off_hz:g}, expected less than {rate_hz / 2:g}, {half}"]


def _contradictions(values: dict[str, Any]) -> list[str]:
    """What does not go together, of numbers that are none the wiser alone."""
    wrong = []
    for low, high, expected, fits in (
        ("bridged_gap_s", "filled_gap_s", "bridged_gap_s or more", lambda a, b: b >= a),
        ("shortest_m", "tallest_m", "more than shortest_m", lambda a, b: b > a),
    ):
        if not _wrong(low, values[low]) and not _wrong(high, values[high]) and not fits(values[low], values[high]):
            wrong.append(f"{high}: found {values[high]:g}, expected {expected} ({values[low]:g})")
    return wrong


def _wrong(name: str, value: Any) -> str:
    if name in POLICIES:
        return "" if value in POLICIES[name] else f"{name}: found {value!r}, expected {' or '.join(POLICIES[name])}"
    if name == "cut_off_hz" and value is None:
        return ""
    if isinstance(value, bool) or not isinstance(value, int | float) or not isfinite(value) or value <= 0:
        return f"{name}: found {value!r}, expected a positive number"
    if name == "kept_share" and value > 1:
        return f"{name}: found {value!r}, expected a share up to 1"
    most = MOST.get(name.rpartition("_")[2], MOST["usual"])
    return f"{name}: found {value!r}, expected {most:g} at most" if value > most else ""

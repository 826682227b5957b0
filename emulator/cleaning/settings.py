"""What cleaning looks for, what it mends, and every number it goes by.

Is it a body, in metres, z up? What is not is refused: a wrong unit cannot be told from a wrong body afterwards.

How far joints go: the angles that are looked at, their limits in degrees, and who says so.

Limits are the widest that the sources give, passive where they tell passive from active, since a false accusation is
worse than a missed fault. AAOS: American Academy of Orthopaedic Surgeons, Joint Motion (1965). Kapandji: The
Physiology of the Joints (2007, 2008). Norkin & White: Measurement of Joint Motion (2016). What directions of bones do
not show (turns about a bone's own axis; which way an elbow bends) has no limit here.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from difflib import get_close_matches
from math import isfinite
from typing import Any

import numpy as np

from emulator.recordings.body_size import SHORTEST_M, TALLEST_M, first_of, wrong_size
from emulator.recordings.take import Recording

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
    shortest_m: float = SHORTEST_M
    tallest_m: float = TALLEST_M

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


LYING, STANDING = 0.3, 0.9


def mistakes(recording: Recording, settings: CleaningSettings) -> list[str]:
    """What speaks against the recording as a whole: place, found and expected; empty if nothing."""
    if settings.plausible == "off":
        return []
    limits_m = settings.shortest_m, settings.tallest_m
    sizes = (wrong_size(take.name, take.positions_m, *limits_m) for take in recording.takes)
    wrong = first_of(list(filter(None, sizes)), len(recording.takes))
    return [*wrong, *_never_seen(recording), *([] if wrong else _wrong_way_up(recording))]


def _never_seen(recording: Recording) -> list[str]:
    """Joints that are seen in no frame of any take."""
    seen = np.any([np.isfinite(take.positions_m).all(axis=-1).any(axis=0) for take in recording.takes], axis=0)
    names = [recording.names[joint] for joint in np.flatnonzero(~seen)]
    return (
        [f"{', '.join(names)}: found in no frame, expected joints that are seen, or none of this name"] if names else []
    )


def _wrong_way_up(recording: Recording) -> list[str]:
    """That bodies stand along another axis than z, all the time."""
    names = recording.names
    top = next((name for name in ("head", "neck") if name in names), None)
    feet = [names.index(name) for name in ("left_ankle", "right_ankle") if name in names]
    if top is None or not feet:
        return []
    up = np.concatenate(
        [take.positions_m[:, names.index(top)] - take.positions_m[:, feet].mean(axis=1) for take in recording.takes]
    )
    up = up[np.isfinite(up).all(axis=-1)]
    if not len(up):
        return []
    x, y, z = np.median(up / np.maximum(np.linalg.norm(up, axis=-1, keepdims=True), 1e-9), axis=0)
    if z < -STANDING:
        return [f"bodies stand on their heads: found the {top} below the feet along z, expected z up"]
    if abs(z) < LYING and max(abs(x), abs(y)) > STANDING:
        axis = "x" if abs(x) > abs(y) else "y"
        return [
            f"bodies stand along {axis}: found the {top} {'+' if (x if axis == 'x' else y) > 0 else '-'}{axis} of the "
            "feet, expected z up (somebody who lies all the time passes with plausible='off')"
        ]
    return []


@dataclass(frozen=True)
class Limit:
    """One angle and how far it goes.

    what     : the movement in words
    joint    : where the angle is, canonical, "{side}" for both sides; ``far`` is the joint that turns about it
    kind     : "bend", between two bones, 0 when straight; "over", a bend against its way; "behind", of the upper arm
               behind the trunk; "lift", of the foot from its angle at the person's start, towards the shin positive
    bones    : of a bend: the joints (from, to, from, to) of its two bones
    low_deg, high_deg : what a body can do
    """

    what: str
    joint: str
    far: str
    kind: str
    bones: tuple[str, str, str, str]
    low_deg: float
    high_deg: float
    source: str


LIMITS = (
    Limit(
        "flexion", "{side}_knee", "{side}_ankle", "bend", ("{side}_hip", "{side}_knee", "{side}_knee", "{side}_ankle"),
        0.0, 160.0, "Kapandji: 160, passive; AAOS: 135",
    ),
    Limit(
        "hyperextension", "{side}_knee", "{side}_ankle", "over",
        ("{side}_hip", "{side}_knee", "{side}_knee", "{side}_ankle"), -180.0, 10.0, "AAOS: 10; Kapandji: 5 to 10",
    ),
    Limit(
        "flexion", "{side}_elbow", "{side}_wrist", "bend",
        ("{side}_shoulder", "{side}_elbow", "{side}_elbow", "{side}_wrist"), 0.0, 160.0,
        "Kapandji: 160, passive; AAOS: 150",
    ),
    Limit(
        "bend", "{side}_wrist", "{side}_hand", "bend", ("{side}_elbow", "{side}_wrist", "{side}_wrist", "{side}_hand"),
        0.0, 90.0, "Kapandji: 85 either way; AAOS: 80 and 70",
    ),
    Limit(
        "flexion", "{side}_hip", "{side}_knee", "bend", ("spine", "pelvis", "{side}_hip", "{side}_knee"),
        0.0, 145.0, "Kapandji: 145, passive with the knee bent; AAOS: 120",
    ),
    Limit(
        "extension", "{side}_shoulder", "{side}_elbow", "behind",
        ("{side}_shoulder", "{side}_elbow", "{side}_shoulder", "{side}_elbow"), -90.0, 60.0, "AAOS: 60; Kapandji: 50",
    ),
    Limit(
        "lift", "{side}_ankle", "{side}_toe", "lift", ("{side}_knee", "{side}_ankle", "{side}_ankle", "{side}_toe"),
        -50.0, 45.0, "down: AAOS and Kapandji: 50; up: Norkin & White: 20, 45 under the body's weight",
    ),
    Limit(
        "bend", "neck", "head", "bend", ("chest", "neck", "neck", "head"), 0.0, 80.0, "Kapandji: 80; AAOS: 45",
    ),
    Limit(
        "bend", "chest", "neck", "bend", ("pelvis", "spine", "chest", "neck"), 0.0, 105.0, "Kapandji: 105; AAOS: 80",
    ),
)  # fmt: skip


def limits_for(names: tuple[str, ...]) -> list[Limit]:
    """The limits of the joints that a skeleton has, each side by itself."""
    both = [_on(limit, side) for limit in LIMITS for side in (("left", "right") if "{" in limit.far else ("",))]
    return [limit for limit in both if {limit.joint, limit.far, *limit.bones} <= set(names)]


def _on(limit: Limit, side: str) -> Limit:
    bones = tuple(joint.format(side=side) for joint in limit.bones)
    assert len(bones) == 4
    return Limit(
        limit.what, limit.joint.format(side=side), limit.far.format(side=side), limit.kind, bones,
        limit.low_deg, limit.high_deg, limit.source,
    )  # fmt: skip

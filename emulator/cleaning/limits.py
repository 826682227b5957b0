"""How far joints go: the angles that are looked at, their limits in degrees, and who says so.

Limits are the widest that the sources give, passive where they tell passive from active, since a false accusation is
worse than a missed fault. AAOS: American Academy of Orthopaedic Surgeons, Joint Motion (1965). Kapandji: The
Physiology of the Joints (2007, 2008). Norkin & White: Measurement of Joint Motion (2016). What directions of bones do
not show (turns about a bone's own axis; which way an elbow bends) has no limit here.
"""

from __future__ import annotations

from dataclasses import dataclass


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

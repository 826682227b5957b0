"""Are left and right where the body says they are? Forward is known from feet, knees, elbows and the way walked.

Left and right are swapped where the body, by its names, would walk backwards: its toes point behind it, its knees bend
the wrong way. Two faults look the same: names swapped, and a mirrored (left-handed) coordinate system. Which of the two
it is no posture can tell, so it is asked for; one limb's names alone against the others are mended.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from emulator.recordings.forward import unit, vector, witnesses_of
from emulator.recordings.take import Take

CLEAR = 0.3
"""A witness speaks where forward by it and by the hips agree or disagree by this much (1 is fully)."""
FIRST, ELSE = ("toes", "knees"), "walking"
"""Feet and knees decide; the way walked only where they are silent. Elbows are told beside and decide nothing."""


@dataclass(frozen=True)
class SidesFound:
    """What was found: ``verdict`` is "as named", "swapped" or "not told"; each witness from -1 (swapped) to 1 (right).

    mended : limbs whose two sides had changed their names against the rest of the body
    """

    verdict: str
    witnesses: dict[str, float]
    mended: tuple[str, ...] = ()

    def words(self) -> str:
        """One sentence."""
        by = ", ".join(f"{name} {value:+.1f}" for name, value in self.witnesses.items())
        mended = f"; names of the {' and '.join(self.mended)} were swapped, mended" if self.mended else ""
        return f"{self.verdict}{f' ({by})' if by else ''}{mended}"


def checked_sides(take: Take) -> tuple[Take, SidesFound]:
    """The take with limbs mended whose names disagree with the others', and whether left is left.

    Needs canonical joints with both hips. The take is returned as it is where the whole body is swapped.
    """
    take, mended = _limbs_mended(take)
    witnesses = witnesses_of(take)
    return take, SidesFound(_verdict(witnesses), witnesses, mended)


def _verdict(witnesses: Mapping[str, float]) -> str:
    spoken = {name: value > 0 for name, value in witnesses.items() if abs(value) >= CLEAR}
    votes = {spoken[name] for name in FIRST if name in spoken}
    if not votes and ELSE in spoken:
        votes = {spoken[ELSE]}
    if len(votes) != 1:
        return "not told"
    return "as named" if votes.pop() else "swapped"


def swapped_names(take: Take) -> Take:
    """The take with left and right exchanged in its names."""
    return _exchanged(take, [name for name in take.names if name.startswith("left_")])


def mirrored(take: Take) -> Take:
    """The take out of a left-handed coordinate system: y changes its sign."""
    return replace(take, positions_m=take.positions_m * np.array([1.0, -1.0, 1.0]))


def _limbs_mended(take: Take) -> tuple[Take, tuple[str, ...]]:
    """Arms, or lower legs, whose names were exchanged: left bones that cross to the right side in most frames."""
    mended = []
    for limb, base, moved in (
        ("lower legs", "hip", ("knee", "ankle", "foot", "heel", "toe")),
        ("feet", "knee", ("ankle", "foot", "heel", "toe")),
        ("forearms", "shoulder", ("elbow", "wrist", "hand", "fingers", "thumb")),
        ("hands", "elbow", ("wrist", "hand", "fingers", "thumb")),
    ):
        if _crossed(take, base, moved[0]):
            take = _exchanged(take, [f"left_{joint}" for joint in moved])
            mended.append(limb)
    if _opposed(take):
        arms = ("clavicle", "shoulder", "elbow", "wrist", "hand", "fingers", "thumb")
        take = _exchanged(take, [f"left_{joint}" for joint in arms])
        mended.append("arms")
    return take, tuple(mended)


def _crossed(take: Take, upper: str, lower: str) -> bool:
    """Whether bones of steady length join each side's upper joint with the other side's lower one."""
    wanted = [f"{side}_{joint}" for side in ("left", "right") for joint in (upper, lower)]
    if not set(wanted) <= set(take.names):
        return False
    own = [_length(take, f"{side}_{upper}", f"{side}_{lower}") for side in ("left", "right")]
    cross = [_length(take, f"left_{upper}", f"right_{lower}"), _length(take, f"right_{upper}", f"left_{lower}")]
    shorter = np.mean((own[0] + own[1]) > (cross[0] + cross[1]) * 1.02)
    steady = sum(map(_spread, cross)) < 0.5 * sum(map(_spread, own))
    longer = np.nanmedian(own[0] + own[1]) > np.nanmedian(cross[0] + cross[1]) * 1.02
    return bool(longer and (shorter > 0.9 or (steady and shorter > 0.6)))


def _opposed(take: Take) -> bool:
    """Whether the shoulder line runs against the hip line nearly always: no trunk is twisted that far."""
    if not {"left_shoulder", "right_shoulder"} <= set(take.names):
        return False
    hips, shoulders = vector(take, "right_hip", "left_hip"), vector(take, "right_shoulder", "left_shoulder")
    cosine = np.sum(unit(hips) * unit(shoulders), axis=-1)
    cosine = cosine[np.isfinite(cosine)]
    return bool(len(cosine) and np.mean(cosine < -0.3) > 0.9)


def _exchanged(take: Take, left: Sequence[str]) -> Take:
    """The take with the positions of these joints and of their right twins exchanged."""
    places = take.positions_m.copy()
    for name in left:
        twin = name.replace("left_", "right_", 1)
        if name in take.names and twin in take.names:
            pair = [take.names.index(name), take.names.index(twin)]
            places[:, pair] = take.positions_m[:, pair[::-1]]
    contact = take.contact
    if contact is not None and "left_ankle" in left:  # said of the feet by their names
        contact = np.asarray(contact)[:, ::-1]
    return replace(take, positions_m=places, contact=contact)


def _length(take: Take, start: str, end: str) -> np.ndarray:
    return np.asarray(np.linalg.norm(vector(take, start, end), axis=-1))


def _spread(lengths: np.ndarray) -> float:
    return float(np.nanstd(lengths)) if np.isfinite(lengths).any() else np.inf

"""Is it a body, upright? What a file or a user says of unit and axis is held against it, by the limits of ``axes``.

Are left and right where the body says they are? Forward is known from feet, knees, elbows and the way walked.

Left and right are swapped where the body, by its names, would walk backwards: its toes point behind it, its knees bend
the wrong way. Two faults look the same: names swapped, and a mirrored (left-handed) coordinate system. Which of the two
it is no posture can tell, so it is asked for; one limb's names alone against the others are mended.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from emulator.recordings.orientation import (
    LONGEST_M,
    SHORTEST_M,
    UNITS_M,
    NotTold,
    body_size,
    found_unit_m,
    found_up,
    turned_up,
    unit,
    vector,
    witnesses_of,
)
from emulator.recordings.take import Take
from emulator.recordings.text import RecordingError

PART_SHARE, SPREAD_SHARE = 0.4, 1.5
"""Points that are no chain from head to feet may show a part of the body only, or arms spread on both sides."""
STANDS_SHARE = 0.15
"""Who stands has the lowest joint nearer to 0 than this share of the body, and it stays so near."""
RESTS_SHARE = 0.04
"""Who lies on the floor has the lowest joint nearer to 0 than this share of the body."""


def checked_body(take: Take, where: str, again: Callable[..., Take], options: dict[str, Any]) -> tuple[str, ...]:
    """Notes on the size of a body in metres, z up, and on one that lies all along.

    again   : reads the take with other options, such as ``unit_m``
    options : with which it was read: ``unit_m`` and ``up`` None where nobody gave them
    Raises RecordingError, both at once, for a size that no body has, and for an axis where another fits clearly.
    """
    wrong = _wrong_size(take, where, again, options)
    lying, refused = _lying(take, where, again, options)
    wrong += refused
    if wrong:
        raise RecordingError("\n".join(wrong))
    size_m, how = body_size(take.positions_m, take.names)
    told = any(note.startswith("unit found from the body") for note in take.notes)
    return (*(() if told or not np.isfinite(size_m) else (f"body: {how} {size_m:.2f} m",)), *lying)


def _wrong_size(take: Take, where: str, again: Callable[..., Take], options: dict[str, Any]) -> list[str]:
    size_m, how = body_size(take.positions_m, take.names)
    whole = how.startswith("from head")
    least, most = (SHORTEST_M, LONGEST_M) if whole else (PART_SHARE * SHORTEST_M, SPREAD_SHARE * LONGEST_M)
    if not np.isfinite(size_m) or least <= size_m <= most:
        return []
    said = _said_unit(take, options)
    by = f" by {said}" if said else ""
    what = "from head to feet" if whole else "between its furthest points"
    hint = _fitting_unit(again) if said else ""
    return [f"{where}: found a body of {size_m:.3g} m {what}{by}, expected {least:.3g} to {most:.3g} m{hint}"]


def _said_unit(take: Take, options: dict[str, Any]) -> str:
    given = options.get("unit_m")
    if given is not None:
        return f"--unit {next((name for name, metres in UNITS_M.items() if metres == given), f'{given:g}')}"
    start = "unit said by the file: "
    return next((f"its unit {n.removeprefix(start)}" for n in take.notes if n.startswith(start)), "") or next(
        ("its unit" for note in take.notes if note.startswith("unit of length")), ""
    )


def _fitting_unit(again: Callable[..., Take]) -> str:
    """The unit that would fit, by the numbers of the file."""
    try:
        raw = again(unit_m=1.0)
        unit_m, _ = found_unit_m(raw.positions_m, raw.names)
    except (NotTold, RecordingError):
        return ""
    size_m = body_size(raw.positions_m, raw.names)[0] * unit_m
    name = next((name for name, metres in UNITS_M.items() if metres == unit_m), f"{unit_m:.6g}")
    return f"; in {name} it would be {size_m:.2f} m: give --unit {name}"


def _lying(
    take: Take, where: str, again: Callable[..., Take], options: dict[str, Any]
) -> tuple[tuple[str, ...], list[str]]:
    """A note where the body lies or hangs head down all along, and a refusal where another axis fits clearly."""
    try:
        up, _ = found_up(take.positions_m, take.names)
    except NotTold:
        return (), []
    if up == "z":
        return (), []
    given = options.get("up")
    by = f" by --up {given}" if given else ""
    posture = "stands on its head" if up == "-z" else "lies"
    if not _stands(take, up) or _rests_on_floor(take):
        return (f"the body {posture} all along{by}: see whether the picture shows it so",), []
    try:
        raw = again(up="z")
        fits = found_up(raw.positions_m, raw.names)[0]
    except (NotTold, RecordingError, TypeError):
        return (f"the body {posture} all along{by}: see whether the picture shows it so",), []
    return (), [
        f"{where}: found a body that {posture} all along{by}, expected one that stands at times; "
        f"along {fits} it stands with its feet at 0: give --up {fits}"
    ]


def stands_along(take: Take) -> str:
    """The axis along which a body, said to be z up, clearly stands; "z" too where it lies or does not tell."""
    up = _found_up(take)
    return up if up != "z" and _stands(take, up) and not _rests_on_floor(take) else "z"


def lies_all_along(take: Take) -> bool:
    """Whether the head is not above the feet most of the time, of a body that stands along no other axis either."""
    return _found_up(take) != "z" and stands_along(take) == "z"


def _found_up(take: Take) -> str:
    try:
        return found_up(take.positions_m, take.names)[0]
    except NotTold:
        return "z"


def _stands(take: Take, up: str) -> bool:
    """Whether the lowest joint along an axis is near 0 and stays there."""
    low, high = np.quantile(_lowest(turned_up(take.positions_m, up)), [0.02, 0.98])
    near = STANDS_SHARE * body_size(take.positions_m, take.names)[0]
    return bool(abs(low) < near and high - low < near)


def _rests_on_floor(take: Take) -> bool:
    """Whether the body, z up, touches the floor at 0 all along, as one that lies there for its exercise does."""
    low, high = np.quantile(_lowest(take.positions_m), [0.02, 0.98])
    near = RESTS_SHARE * body_size(take.positions_m, take.names)[0]
    return bool(abs(low) < near and high < 2 * near)


def _lowest(positions_m: np.ndarray) -> np.ndarray:
    height = np.where(np.isfinite(positions_m).all(axis=-1), positions_m[..., 2], np.inf).min(axis=1)
    height = height[np.isfinite(height)]
    return height if len(height) else np.zeros(1)


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

"""The measures of postures from the positions of joints, by ``angles.py``: the definition, written to be read.

The measures of drawn performances: each cut into even parts, the posture in the middle of each part measured.

What a skeleton does not tell, as sentences: which scores remain, and which become wider.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from opsim.ergonomics import angles
from opsim.ergonomics.angles import (
    AT,
    CANONICAL,
    COLUMNS,
    SIDES,
    body_frame,
    bone_chain,
    both_sides_m,
    check_reference,
    in_frame,
    joint_places,
    joints_m,
    trunk_frame,
    unit,
)
from opsim.ergonomics.options import USUAL, Options

__all__ = ["first_measures", "has_body", "measures_of", "measures_of_joints", "measures_of_positions", "n_cells"]


OWN_SIDE = np.array([1.0, -1.0])
"""Which way along y the own side lies, of left and right."""
FEET = ("left_ankle", "right_ankle", "left_toe", "right_toe")


def measures_of_positions(
    positions_m: np.ndarray, names: Sequence[str], options: Options = USUAL, neck_neutral_rad: float = 0.0
) -> np.ndarray:
    """Joints (..., J, 3) in metres, z up, named by ``names`` (J,) -> measures (..., COLUMNS) as ``columns.py`` says.

    A measure is nan where the skeleton lacks a joint it needs, or a posture does not have it. In lengths the wrist
    stands for a hand that is missing; the floor is the lowest of the ankles and toes that there are: without toes it
    is as high as an ankle (``missing_scores`` says so).
    Raises ValueError where positions are not (..., J, 3), or for an unknown reference of arms.
    """
    body = _canonical(np.asarray(positions_m, dtype=float), names)
    out = np.empty((*body.shape[:-2], len(COLUMNS)))
    for name, values in {**_angles_deg(body, options, neck_neutral_rad), **_lengths_m(body)}.items():
        out[..., AT[name]] = values
    return out


def _canonical(positions_m: np.ndarray, names: Sequence[str]) -> np.ndarray:
    """(..., 21, 3) the joints that measures are made of; nan where a joint is missing."""
    here = [name for name in CANONICAL if name in names]
    found = np.full((*positions_m.shape[:-2], len(CANONICAL), 3), np.nan)
    for name, joint_m in zip(here, joints_m(positions_m, names, *here)):
        found[..., CANONICAL.index(name), :] = joint_m
    return found


def _angles_deg(body: np.ndarray, options: Options, neck_neutral_rad: float) -> dict[str, np.ndarray]:
    trunk = angles.trunk_angles(body, CANONICAL)
    neck = angles.neck_angles(body, CANONICAL, neck_neutral_rad)
    arms = angles.upper_arm_angles(body, CANONICAL, options.arm_reference)
    found = {"trunk_flexion": trunk.flexion_rad, "trunk_side": trunk.side_bend_rad, "trunk_twist": trunk.twist_rad}
    found |= {"neck_flexion": neck.flexion_rad, "neck_side": neck.side_bend_rad}
    found |= _sided("arm_flexion", arms.flexion_rad) | _sided("arm_abduction", arms.abduction_rad)
    found |= _sided("arm_elevation", _elevation_rad(body))
    found |= _sided("elbow", angles.elbow_bend_rad(body, CANONICAL))
    found |= _sided("wrist", angles.wrist_bend_rad(body, CANONICAL))
    found |= _sided("knee", angles.knee_bend_rad(body, CANONICAL))
    return {name: np.rad2deg(angle) for name, angle in found.items()}


def _lengths_m(body: np.ndarray) -> dict[str, np.ndarray]:
    shoulder, elbow, wrist, hand, ankle = (
        both_sides_m(body, CANONICAL, joint) for joint in ("shoulder", "elbow", "wrist", "hand", "ankle")
    )
    hand = np.where(np.isnan(hand).any(axis=-1, keepdims=True), wrist, hand)
    pelvis, neck, *feet = joints_m(body, CANONICAL, "pelvis", "neck", *FEET)
    floor_m = np.fmin.reduce([foot[..., 2] for foot in feet])
    trunk = trunk_frame(body, CANONICAL)[..., None, :, :]
    outside = in_frame(trunk, hand - shoulder)[..., 1] * OWN_SIDE
    across = -in_frame(trunk, hand - neck[..., None, :])[..., 1] * OWN_SIDE
    reach = in_frame(body_frame(body, CANONICAL), (hand.mean(axis=-2) - ankle.mean(axis=-2)))
    found = _sided("elbow_above_m", elbow[..., 2] - shoulder[..., 2])
    found |= _sided("across_m", across) | _sided("outside_m", outside)
    found |= _sided("hand_up_m", hand[..., 2] - floor_m[..., None])
    found |= {"hands_forward_m": reach[..., 0], "hands_left_m": reach[..., 1]}
    return found | _sided("ankle_up_m", ankle[..., 2] - floor_m[..., None]) | {"pelvis_up_m": pelvis[..., 2] - floor_m}


def _elevation_rad(body: np.ndarray) -> np.ndarray:
    """(..., 2) of the upper arms against gravity; no heading is asked for, so hips do not matter."""
    shoulder, elbow = (both_sides_m(body, CANONICAL, joint) for joint in ("shoulder", "elbow"))
    u = unit(elbow - shoulder)
    return np.arctan2(np.hypot(u[..., 0], u[..., 1]), -u[..., 2])


def _sided(name: str, both: np.ndarray) -> dict[str, np.ndarray]:
    """Of (..., 2), by the names of both sides."""
    return {f"{side}_{name}": both[..., place] for place, side in enumerate(SIDES)}


MOST_CELLS = 2**16
"""Of one performance: at 12 a second those longer than 91 minutes are looked at less often."""
AT_ONCE_BYTES = 2**24
"""Bones or joints held at a time."""


def has_body(block: Any) -> bool:
    """Whether performances have postures at all."""
    return getattr(block, "skeleton", None) is not None


def n_cells(block: Any, options: Options = USUAL) -> int:
    """Even parts C into which each performance of a block is cut: at least ``rate_hz`` a second of the longest."""
    return int(np.clip(np.ceil(np.max(block.duration_s) * options.rate_hz), 1, MOST_CELLS))


def measures_of(
    block: Any, rows: Sequence[int] | np.ndarray, options: Options = USUAL, neck_neutral_rad: float = 0.0
) -> np.ndarray:
    """Measures (m, C, len(COLUMNS)) in the middles of C even parts of some performances of a block that has bodies.

    C is ``n_cells``, the same for all of a block. What no posture tells is nan, as in ``measures_of_positions``, to
    which this comes to 1e-9. Where the block can be taken apart, only the rows asked for are decoded.
    Raises ValueError where postures have another shape than the seam promises, or for an unknown reference of arms.
    """
    rows, cells = np.asarray(rows, dtype=int), n_cells(block, options)
    out = np.empty((rows.size, cells, len(COLUMNS)))
    filled, n_times = (_in_the_middles, cells) if _has_directions(block) else (_by_positions, 2 * cells + 1)
    together = max(1, AT_ONCE_BYTES // (24 * len(block.skeleton.names) * n_times))
    apart = hasattr(type(block), "__getitem__")
    for start in range(0, rows.size if apart else 0, together):
        some = slice(start, start + together)
        filled(block[rows[some]], options, neck_neutral_rad, out[some])
    if not apart:
        whole = np.empty((len(block.duration_s), *out.shape[1:]))
        filled(block, options, neck_neutral_rad, whole)
        out[:] = whole[rows]
    return out


def first_measures(block: Any, options: Options = USUAL) -> np.ndarray:
    """Measures (n, len(COLUMNS)) of the postures in which the performances of a block begin; neck against the trunk."""
    if not _has_directions(block):
        return measures_of_joints(_joints_m(block, 2)[:, 0], block.skeleton.names, options)
    out = np.empty((len(block.duration_s), 1, len(COLUMNS)))
    _by_directions(block, np.zeros(1), options, 0.0, out)
    return out[:, 0]


def measures_of_joints(
    positions_m: np.ndarray, names: Sequence[str], options: Options = USUAL, neck_neutral_rad: float = 0.0
) -> np.ndarray:
    """``measures_of_positions`` of many postures: joints (..., J, 3) in metres -> (..., len(COLUMNS)), to 1e-9.

    Raises ValueError as that does.
    """
    from opsim.ergonomics.kernels.postures import measure_joints

    positions_m, said = np.asarray(positions_m, dtype=float), (len(names), 3)
    if positions_m.shape[-2:] != said:
        raise ValueError(f"positions of {len(names)} joints must be (..., {len(names)}, 3), found {positions_m.shape}")
    check_reference(options.arm_reference)
    flat = np.ascontiguousarray(positions_m.reshape(-1, *said))
    out = np.empty((len(flat), len(COLUMNS)))
    measure_joints(flat, joint_places(names), float(np.rad2deg(neck_neutral_rad)), _gravity(options), out)
    return out.reshape(*positions_m.shape[:-2], len(COLUMNS))


def _has_directions(block: Any) -> bool:
    """Whether bones are at hand: then nobody need find the path over the floor, four fifths of ``positions_m``."""
    return hasattr(block, "directions") and hasattr(block, "bone_length_m") and hasattr(block.skeleton, "parents")


def _in_the_middles(block: Any, options: Options, neck_neutral_rad: float, out: np.ndarray) -> None:
    """Measures of all of a block into out (n, C, COLUMNS), in the middles of C even parts."""
    _by_directions(block, (np.arange(out.shape[1]) + 0.5) / out.shape[1], options, neck_neutral_rad, out)


def _by_directions(block: Any, shares: np.ndarray, options: Options, neck_neutral_rad: float, out: np.ndarray) -> None:
    """Measures of all of a block into out (n, C, COLUMNS) at shares (C,) of its times, from bones alone."""
    from opsim.ergonomics.kernels.postures import measure_hung

    check_reference(options.arm_reference)
    directions = np.asarray(block.directions(times_s=np.asarray(block.duration_s)[:, None] * shares))
    lengths_m, chain = np.asarray(block.bone_length_m, dtype=float), bone_chain(block.skeleton.parents)
    _check(block, "directions", directions, (*out.shape[:2], len(chain), 3))
    _check(block, "bone_length_m", lengths_m, (len(out), len(chain)))
    neutral_deg = float(np.rad2deg(neck_neutral_rad))
    measure_hung(
        np.ascontiguousarray(directions),
        np.ascontiguousarray(lengths_m),
        chain,
        joint_places(block.skeleton.names),
        neutral_deg,
        _gravity(options),
        out,
    )


def _by_positions(block: Any, options: Options, neck_neutral_rad: float, out: np.ndarray) -> None:
    """The same of any emulator: of 2 C + 1 even points the odd ones are the middles of C parts."""
    middles_m = _joints_m(block, 2 * out.shape[1] + 1)[:, 1::2]
    out[:] = measures_of_joints(middles_m, block.skeleton.names, options, neck_neutral_rad)


def _joints_m(block: Any, n_times: int) -> np.ndarray:
    """(n, T, J, 3) metres at even points."""
    found = np.asarray(block.positions_m(n_times=n_times), dtype=float)
    _check(block, "positions_m", found, (len(block.duration_s), n_times, len(block.skeleton.names), 3))
    return found


def _check(block: Any, what: str, found: np.ndarray, expected: tuple[int, ...]) -> None:
    if found.shape != expected:
        raise ValueError(f"{type(block).__name__}.{what} gave {found.shape}, expected {expected}")


def _gravity(options: Options) -> bool:
    return options.arm_reference == "gravity"


TRUNK = ("pelvis", "neck", "left_hip", "right_hip")
SHOULDERS = ("left_shoulder", "right_shoulder")


def missing_scores(names: Sequence[str]) -> list[str]:
    """Sentences, none where a skeleton of joints ``names`` has all that RULA, REBA and OWAS look at.

    A sub-score that cannot be seen counts as anything from its lowest to its highest; what none can be made of is said.
    """
    gone = [joint for joint in CANONICAL if joint not in names]
    return list(_sentences(set(gone)))


def _sentences(gone: set[str]) -> Iterator[str]:
    all_scores = "RULA, REBA and OWAS"
    trunk = _listed(gone, TRUNK)
    if trunk:
        bent = "trunk and knees are" if gone & {"left_hip", "right_hip"} else "the trunk is"
        yield f"no {trunk}: how far {bent} bent is not known, and {all_scores} are wider by all that it may be"
    shoulders = _listed(gone, SHOULDERS)
    if shoulders:
        yield f"no {shoulders}: twist of the trunk, neck and upper arms are not known: {all_scores} are wider by all"
    if "head" in gone:
        yield "no head: the neck is not known, so RULA and REBA are wider by all that it may be; OWAS does not ask"
    yield from _arm(gone)
    legs = _listed(gone, tuple(f"{side}_{joint}" for joint in ("knee", "ankle") for side in SIDES))
    if legs:
        yield f"no {legs}: how far knees are bent is not known, so REBA and OWAS are wider; RULA does not ask"
    yield from _feet(gone)


def _feet(gone: set[str]) -> Iterator[str]:
    """What heights and reaches of the hands are made of; no score asks for them, NIOSH and Garg do."""
    ankles, toes = (_listed(gone, _both(joint)) for joint in ("ankle", "toe"))
    if ankles:
        yield (
            f"no {ankles}: how far the hands are from them is not known, so no lift is seen: there is no lifting "
            "index, and energy has none of it"
        )
    elif toes == "toes":
        yield (
            "no toes: the floor is taken where the lower ankle is, so in lifts and bends hands are lower than they "
            "are, by the height of an ankle; RULA, REBA and OWAS do not ask"
        )


def _arm(gone: set[str]) -> Iterator[str]:
    elbows, wrists, hands = (_listed(gone, _both(joint)) for joint in ("elbow", "wrist", "hand"))
    if elbows:
        yield f"no {elbows}: upper arm and elbow are not known, so RULA, REBA and OWAS are wider by both"
    if wrists:
        both = _listed(gone, (*_both("wrist"), *_both("hand")))
        yield (
            f"no {both}: how far elbow and wrist are bent is not known, so RULA and REBA are wider by both; OWAS "
            "does not ask"
        )
    elif hands:
        yield (
            f"no {hands}: how far the wrist is bent is not known, so RULA and REBA are wider by it; OWAS does not ask. "
            "Heights and reaches are those of the wrist"
        )


def _both(joint: str) -> tuple[str, ...]:
    return tuple(f"{side}_{joint}" for side in SIDES)


def _listed(gone: set[str], joints: Sequence[str]) -> str:
    """Those that are gone, in words: "wrists" where both sides are, else by name."""
    words: list[str] = []
    for joint in joints:
        other = joint.removeprefix("left_").removeprefix("right_")
        both = other != joint and set(_both(other)) <= gone
        word = f"{other}s" if both else joint.replace("_", " ")
        words += [word] if joint in gone and word not in words else []
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} or {words[-1]}" if words else ""

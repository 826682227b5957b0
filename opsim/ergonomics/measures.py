"""The measures of drawn performances: each cut into even parts, the posture in the middle of each part measured."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from opsim.ergonomics.angles import check_reference
from opsim.ergonomics.chains import bone_chain, joint_places
from opsim.ergonomics.columns import COLUMNS
from opsim.ergonomics.options import USUAL, Options
from opsim.ergonomics.posture_measures import measures_of_positions

__all__ = ["first_measures", "has_body", "measures_of", "measures_of_joints", "measures_of_positions", "n_cells"]

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
    from opsim.ergonomics.kernels.measuring import measure_joints

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
    from opsim.ergonomics.kernels.measuring import measure_hung

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

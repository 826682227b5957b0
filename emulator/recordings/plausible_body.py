"""Is it a body, upright? What a file or a user says of unit and axis is held against it, by the limits of ``axes``."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from emulator.recordings import RecordingError
from emulator.recordings.axes import (
    LONGEST_M,
    SHORTEST_M,
    UNITS_M,
    NotTold,
    body_size,
    found_unit_m,
    found_up,
    turned_up,
)
from emulator.recordings.take import Take

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

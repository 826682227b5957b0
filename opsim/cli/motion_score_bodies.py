"""Whether the takes of a recording are upright bodies in metres, and which of their joints are not seen, and when."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

FURTHEST_M = 1e5
"""From the origin of a recording: further away, single precision no longer tells a finger's width."""
SEE = "see `opsim motion import`, which finds unit and axis"
WORTH_SAYING = 0.001


def wrong_bodies(recording: Any, where: str) -> list[str]:
    """Why takes are refused: nothing seen, no place in a room, a size that no body has, standing along another axis."""
    if not any(np.isfinite(take.positions_m).any() for take in recording.takes):
        return [f"{where}: found no position at all, expected joints of a body in metres"]
    wrong: dict[str, list[tuple[str, str]]] = {}
    for take in recording.takes:
        for found, expected in _why_refused(take):
            wrong.setdefault(expected, []).append((take.name, found))
    return [
        f"{where}: {_takes([name for name, _ in each], len(recording.takes))}"
        f"found {each[0][1]}, expected {expected}; {SEE}"
        for expected, each in wrong.items()
    ]


def _takes(names: list[str], n_takes: int) -> str:
    if len(names) == n_takes:
        return ""
    return f"take{'s' if len(names) > 1 else ''} {', '.join(names[:6])}{', ...' if len(names) > 6 else ''}: "


def _why_refused(take: Any) -> Iterator[tuple[str, str]]:
    """What is found and what is expected: takes of which the same is expected are one sentence."""
    from emulator.recordings.orientation import LONGEST_M, SHORTEST_M, body_size
    from emulator.recordings.plausibility import PART_SHARE, SPREAD_SHARE, stands_along

    if not np.isfinite(take.positions_m).any():
        return
    furthest_m = float(np.nanmax(np.abs(take.positions_m)))
    if furthest_m > FURTHEST_M:
        yield f"a coordinate of {furthest_m:.3g} m", "a place in metres"
        return
    size_m, how = body_size(take.positions_m, take.names)
    whole = how.startswith("from head")
    least, most = (SHORTEST_M, LONGEST_M) if whole else (PART_SHARE * SHORTEST_M, SPREAD_SHARE * LONGEST_M)
    if np.isfinite(size_m) and not least <= size_m <= most:
        yield f"a body of {size_m:.3g} m", f"{least:.3g} to {most:.3g} m: it is not in metres"
    elif stands_along(take) != "z":
        yield f"a body that stands along {stands_along(take)}", "z: it does not stand upright"


def seen_joints(recording: Any) -> tuple[str, ...]:
    """Those that are seen in some frame."""
    seen = np.any([np.isfinite(take.positions_m).all(axis=-1).any(axis=0) for take in recording.takes], axis=0)
    return tuple(name for name, there in zip(recording.names, seen) if there)


def gaps(recording: Any) -> Iterator[str]:
    """Sentences on bodies that lie or hang, takes without any position, and joints that are not seen all the time."""
    from emulator.recordings.plausibility import lies_all_along

    lying = [take.name for take in recording.takes if np.isfinite(take.positions_m).any() and lies_all_along(take)]
    if lying:
        yield f"{_takes(lying, len(recording.takes))}does not stand upright at any time; {SEE}, if it should"
    empty = [take.name for take in recording.takes if not np.isfinite(take.positions_m).any()]
    if empty:
        yield f"missing: nothing is known of {', '.join(empty[:6])}{', ...' if len(empty) > 6 else ''}"
    there = np.concatenate([np.isfinite(take.positions_m).all(axis=-1) for take in recording.takes])
    there = there[there.any(axis=1)]
    unseen = 1.0 - there.mean(axis=0)
    some = [
        f"{name.replace('_', ' ')} {100 * share:.1f} %"
        for name, share in zip(recording.names, unseen)
        if WORTH_SAYING <= share < 1.0
    ]
    if some:
        yield f"missing: not seen for a part of the time, where scores are wider: {', '.join(some)}"

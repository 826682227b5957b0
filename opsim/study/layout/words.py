"""A change of the layout in words: ``swap press and wash and move packing to bay_7``."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from opsim.names import enumerated, natural_key
from opsim.study.layout.moves import Candidate

MOST_SAID, MOVE = 4, "move "


def said(before: Mapping[str, str], candidate: Candidate, *, brief: bool = False) -> str:
    """What to do so that today's layout (place of each station) becomes the other one, in few words.

    brief : of many moves only how many they are
    """
    steps = list(_steps(before, candidate))
    if len(steps) > MOST_SAID:
        moved = [name for name, place in candidate.at.items() if before.get(name) != place]
        if brief:
            return f"move {len(moved)} stations"
        return f"move {len(moved)} stations ({', '.join(f'{name} to {candidate.at[name]}' for name in moved)})"
    return enumerated([_short(step, before) for before, step in zip(["", *steps], steps)])


def _short(step: str, before: str) -> str:
    """``saw to b4`` after another move: ``move press to a3 and saw to b4``."""
    return step.removeprefix(MOVE) if before.startswith(MOVE) else step


def moved_stations(before: Mapping[str, str], candidate: Candidate) -> list[str]:
    """The stations that stand elsewhere than before."""
    return [name for name, place in candidate.at.items() if before.get(name, place) != place]


def _steps(before: Mapping[str, str], candidate: Candidate) -> Iterator[str]:
    moved = {name: candidate.at[name] for name in sorted(moved_stations(before, candidate), key=natural_key)}
    done: set[str] = set()
    for name, place in moved.items():
        if name in done:
            continue
        other = next((one for one in moved if before[one] == place and moved[one] == before[name]), None)
        if other is not None:
            done |= {name, other}
            yield f"swap {name} and {other}"
    for name, place in moved.items():
        if name not in done:
            yield f"{MOVE}{name} to {place}"
    for place, (x, y) in candidate.moved.items():
        yield f"put {place} at ({x:g} m, {y:g} m)"
    for name in candidate.added:
        yield f"add {name} at {candidate.at[name]}"

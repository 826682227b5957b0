"""Cleaning on recordings: the known glitches are found, little else is touched; pictures before and after."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from emulator.cleaning import Cleaned, cleaned
from emulator.recordings.npz import read_recording
from opsim.cli.motion.clean import change_mm, notes_of, verdicts_of
from opsim.cli.motion.clean_page import view_of
from opsim.report.motion.cleaning_charts import write_cleaned

GLITCHED = {"dg/026", "dg/027", "dg/028", "dg/030"}
MOST_OTHERS = 2
PICTURES = ("hdm05_squat_once", "hdm05_throw_ball", "hdm05_deposit_floor")
CLEAN = ("bandai2_", "uiprmd_")
"""Collections without known faults."""


def evidence(motion: Path, out: Path) -> Iterator[tuple[str, str, bool]]:
    """(claim, what was found, whether it holds), with pictures written into ``out``."""
    done = {path.stem: cleaned(read_recording(path)) for path in sorted(motion.glob("*.npz"))}
    for name in PICTURES:
        if name in done:
            each = done[name]
            write_cleaned(view_of(each, f"{name}: {verdicts_of(each)}", notes_of(each)), out / f"cleaned_{name}.svg")
    yield from _squats(done["hdm05_squat_once"])
    for name, each in done.items():
        yield _untouched(name, each)
    again = {name: cleaned(each.recording) for name, each in done.items()}
    changed = [name for name, each in again.items() if max(change_mm(each)) > 0]
    yield "cleaning twice is cleaning once", f"{len(done) - len(changed)} of {len(done)} files, {changed}", not changed


def _squats(done: Cleaned) -> Iterator[tuple[str, str, bool]]:
    glitched = {repair.take for repair in done.repairs if repair.kind == "glitch"}
    others = sorted(glitched - GLITCHED)
    yield (
        "squats: dg 026, 027, 028 and 030 are found, and at most two others",
        f"glitches in {', '.join(sorted(glitched))}; others: {', '.join(others) or 'none'}",
        glitched >= GLITCHED and len(others) <= MOST_OTHERS,
    )
    bad = {name for name in done.names if done.verdict(name) in ("bad", "left out")}
    others = {word: [n for n in done.names if word in done.verdict(n).split(", ")] for word in ("repaired", "told")}
    yield (
        "squats: bad are these, since their feet turn over and stay so, and at most two others",
        f"{verdicts_of(done)}; bad: {', '.join(sorted(bad))}; repaired: {', '.join(others['repaired'])}; "
        f"told of feet beyond what ankles can do: {', '.join(others['told'])}",
        bad >= GLITCHED and len(bad - GLITCHED) <= MOST_OTHERS,
    )


def _untouched(name: str, done: Cleaned) -> tuple[str, str, bool]:
    moved = change_mm(done)
    kinds = Counter((repair.kind, "mended" if repair.mended else "told") for repair in done.repairs)
    said = ", ".join(f"{n} {kind} {what}" for (kind, what), n in kinds.items()) or "nothing"
    found = f"{verdicts_of(done)}; {said}; median take moved by {np.median(moved):.3g} mm, at most {max(moved):.3g} mm"
    accused = [take for take in done.names if done.verdict(take) in ("bad", "left out")]
    holds = np.median(moved) < 0.01 and (not name.startswith(CLEAN) or (not accused and max(moved) < 0.01))
    claim = (
        "no take is called bad or moved" if name.startswith(CLEAN) else "the median take is moved by less than 0.01 mm"
    )
    return f"{name}: {claim}", found, bool(holds)

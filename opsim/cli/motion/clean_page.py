"""From what cleaning found to what a picture shows."""

from __future__ import annotations

from typing import Any

import numpy as np

from opsim.report.motion.cleaning import CleanedView, Finding, Mended, TakeCard

MOST_BESIDE = 3
FULL = {"m": 0.2, "s": 0.5, "%": 10.0, "deg": 60.0, "m/s": 12.0, "mm": 10.0}
"""The size, by its unit, that has the darkest colour."""
SHOWN = ("swap", "glitch", "jump", "slip", "gap", "cut", "offset", "angle", "noise")
"""Kinds that are worth a look before and after."""
NEVER_A_FAULT = ("hold", "heading", "still")


def view_of(cleaned: Any, title: str, notes: list[str], *, panels: bool = True) -> CleanedView:
    """The picture of a ``emulator.cleaning.Cleaned``, with before and after of the worst or without."""
    from emulator.cleaning import KINDS

    present = {repair.kind for repair in cleaned.repairs}
    kinds = [(kind, words) for kind, words in KINDS.items() if kind in present]
    return CleanedView(title, cards_of(cleaned), kinds, _worst(cleaned) if panels else [], notes)


def cards_of(cleaned: Any) -> list[TakeCard]:
    """Each take with what is said of it and what was found in it."""
    return [
        TakeCard(name, take.duration_s, cleaned.verdict(name), tuple(_finding(r, take) for r in cleaned.of(name)))
        for name, take in zip(cleaned.names, cleaned.before.takes)
    ]


def size_words(size: float, unit: str) -> str:
    """A size short enough for a cell."""
    if unit == "m":
        return f"{100 * size:.1f} cm"
    return f"{size:.{2 if unit == 's' else 1 if size < 9.95 else 0}f} {unit}".replace(" deg", "°")


def share_of(repair: Any) -> float:
    return min(1.0, float(repair.size) / FULL.get(repair.unit, 1.0))


def _finding(repair: Any, take: Any) -> Finding:
    at = (repair.first_frame / take.rate_hz, repair.last_frame / take.rate_hz)
    who = f"{' and '.join(repair.joints)}: " if repair.joints else ""
    size = size_words(repair.size, repair.unit)
    mended = repair.mended and not repair.shortens
    return Finding(repair.kind, *at, size, share_of(repair), mended, who + repair.words, column_of(repair))


def column_of(repair: Any) -> str:
    """Where it stands in a table: what was mended apart from what was left, and either with one unit."""
    if repair.shortens:
        return "shortened"
    if repair.mended or repair.kind in NEVER_A_FAULT:
        return str(repair.kind)
    other = repair.kind == "glitch" and repair.unit == "m"  # the size of a jump, beside changes of speed
    return f"{repair.kind} left" + (" by" if other else "")


def _worst(cleaned: Any) -> list[Mended]:
    """The repairs to be seen before and after: the largest of different takes, what was mended before what was left."""
    from emulator.skeleton import Skeleton

    taken: dict[str, Mended] = {}
    if cleaned.before.parents is None:
        return []
    skeleton = Skeleton(cleaned.before.names, cleaned.before.parents)
    ranked = sorted(
        (repair for repair in cleaned.repairs if repair.kind in SHOWN and repair.joints),
        key=lambda r: (not r.mended, not r.bad, -share_of(r), r.take, r.first_frame),
    )
    pairs = {name: (before, after) for name, before, after in cleaned.pairs()}
    for repair in ranked:
        if repair.take in pairs and repair.take not in taken and len(taken) < MOST_BESIDE:
            taken[repair.take] = _beside(cleaned, repair, *pairs[repair.take], skeleton)
    return list(taken.values())


def _beside(cleaned: Any, repair: Any, before: Any, after: Any, skeleton: Any) -> Mended:
    after_m = np.full(before.positions_m.shape, np.nan)
    start = cleaned.first_frame(repair.take)
    after_m[start : start + after.n_frames] = after.positions_m
    joint = before.names.index(repair.joints[0])
    if repair.kind in ("angle", "offset") and joint in before.parents:  # what turns is what hangs on the joint
        joint = before.parents.index(joint)
    return Mended(
        repair.take,
        cleaned.verdict(repair.take),
        before.names[joint],
        repair.words if before.names[joint] in repair.joints else f"{repair.joints[0]} {repair.words}",
        np.arange(before.n_frames) / before.rate_hz,
        np.where(np.isfinite(before.positions_m), before.positions_m, np.nan),
        after_m,
        repair.first_frame / before.rate_hz,
        repair.last_frame / before.rate_hz,
        _worst_frame(before.positions_m[:, joint], after_m[:, joint], repair) / before.rate_hz,
        skeleton,
        repair.mended,
    )


def _worst_frame(before_m: np.ndarray, after_m: np.ndarray, repair: Any) -> int:
    """Where the joint was moved most; where it was not moved or not seen, the middle."""
    inside = slice(repair.first_frame, repair.last_frame + 1)
    moved = np.nan_to_num(np.linalg.norm(after_m[inside] - before_m[inside], axis=-1), nan=0.0)
    if moved.max(initial=0.0) > 1e-4:
        return int(repair.first_frame + moved.argmax())
    return int((repair.first_frame + repair.last_frame) // 2)

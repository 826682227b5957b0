"""What the picture of ``opsim motion segment`` shows: takes that were cut, as arrays."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

MOST_PIECES = 6
AWAY = "distance from rest, no unit\n(change of bone directions)"


def picture(found: Sequence[Any], of: int, path: Path) -> None:
    """Draw the takes (Segments), the first of so many."""
    from opsim.report.motion.segmentation import draw_cuts

    views = [view(segments) for segments in found]
    draw_cuts(views, path, heading=f"the first {len(views)} of {of} takes" if of > len(views) else "")


def view(segments: Any) -> Any:
    """One take as a ``CutTake``."""
    from emulator.skeleton import Skeleton
    from opsim.report.motion.segmentation import CutTake

    take, rate_hz = segments.take, segments.take.rate_hz
    curve, says = _curve(segments)
    what = {"given": "pieces as given"}.get(segments.kind, segments.kind)
    manifold = None if segments.curve is None else segments.curve.coordinates
    flat = manifold is not None and manifold.shape[1] > 1
    said = "" if segments.curve is None else f", intrinsic dimension {segments.curve.dimension}"
    return CutTake(
        title=f"{take.name}: {len(segments.cuts)} {what} in {take.duration_s:.1f} s{said}",
        time_s=np.arange(take.n_frames) / rate_hz,
        curve=curve,
        says=says,
        pieces=[(cut.start / rate_hz, cut.stop / rate_hz, cut.name) for cut in segments.cuts],
        skeleton=Skeleton(take.names, take.parents),
        positions_m=take.positions_m,
        posture_s=_postures(segments) / rate_hz,
        units=[(unit.name, unit.start / rate_hz, unit.stop / rate_hz) for unit in segments.units],
        manifold=manifold[:, :2] if flat and manifold is not None else None,
        manifold_s=segments.frames / rate_hz,
    )


def _curve(segments: Any) -> tuple[np.ndarray, str]:
    if segments.cycles is not None:
        return segments.cycles.smooth, "coordinate on the manifold,\nno unit"
    found = segments.repetitions
    if found is None:
        from emulator.segmenting.repetitions import postures, repetitions

        try:
            found = repetitions(postures(segments.take), segments.take.rate_hz)
        except ValueError:
            return np.zeros(segments.take.n_frames), "nothing to show: gaps"
    return found.away, AWAY


def _postures(segments: Any) -> np.ndarray:
    """Frames at which a body is drawn: the begin and the furthest frame (or the middle) of pieces, and the last end."""
    chosen = np.unique(np.rint(np.linspace(0, len(segments.cuts) - 1, MOST_PIECES)).astype(int))
    cuts = [segments.cuts[i] for i in chosen]
    middle = [(cut.start + cut.stop) // 2 for cut in cuts]
    if segments.repetitions is not None:
        middle = segments.repetitions.furthest[chosen].tolist()
    return np.unique(np.array([*(cut.start for cut in cuts), *middle, cuts[-1].stop], dtype=int))

"""The pieces of a cut take as takes of their own."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from emulator.recordings.take import Recording, Take
from emulator.segmenting.segment import Cut, Segments


def piece(take: Take, cut: Cut) -> Take:
    """Frames ``cut.start`` to ``cut.stop`` of a take: same worker, trial "<trial>.<name>", the marks within."""
    inside = slice(cut.start, cut.stop + 1)
    marks = {name: at - cut.start for name, at in take.mark_frame.items() if cut.start <= at <= cut.stop}
    return replace(
        take,
        positions_m=take.positions_m[inside],
        trial=f"{take.trial}.{cut.name}",
        mark_frame=marks,
        contact=None if take.contact is None else np.asarray(take.contact)[inside],
    )


def cut_recording(recording: Recording, found: Sequence[Segments], said: str) -> Recording:
    """All pieces of a recording, in order, with notes on what was done. Raises ValueError where there is none.

    A mark is kept where every piece has it.
    """
    pieces = [piece(segments.take, cut) for segments in found for cut in segments.cuts]
    if not pieces:
        raise ValueError("nothing was cut: found no repetition in any take")
    every = set(recording.takes[0].mark_frame)
    shared = set.intersection(*(set(one.mark_frame) for one in pieces))
    pieces = [replace(one, mark_frame={n: at for n, at in one.mark_frame.items() if n in shared}) for one in pieces]
    lost = [f"the mark {name} was left out: not every piece has it" for name in sorted(every - shared)]
    notes = (*recording.notes, f"{said}: {len(pieces)} pieces of {len(found)} takes", *lost)
    return replace(recording, takes=tuple(pieces), notes=notes)

"""Cleaning a recording: each step after the other, everything that is found counted."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from emulator.cleaning.bones_and_angles import median_lengths_m, neutral_angles, with_even_bones, within_limits
from emulator.cleaning.gaps import without_gaps
from emulator.cleaning.marker_errors import without_offsets, without_slips, without_swaps
from emulator.cleaning.report import KINDS, Cleaned, Repair, impossible, take_names, told
from emulator.cleaning.settings import CleaningSettings, beyond_rate, mistakes
from emulator.cleaning.smoothing import smoothed
from emulator.cleaning.spikes import violent_steps, without_jumps
from emulator.recordings.take import Recording, Take

Report = Callable[..., None]
MOST_ROUNDS = 5


def cleaned(recording: Recording, settings: CleaningSettings | None = None, progress: Report | None = None) -> Cleaned:
    """The recording with what could be mended, and everything that was found, mended or not.

    settings : ``CleaningSettings()`` where None
    progress : called with (done, total, label) after each take of each round
    Raises ValueError with everything that makes it no recording of bodies in metres, z up, for a cut-off that its frame
    rate has no room for, and where no take is left.
    """
    settings = CleaningSettings() if settings is None else settings
    read, recording = recording, replace(recording, takes=tuple(_finite(take) for take in recording.takes))
    wrong = [*mistakes(recording, settings), *beyond_rate(settings.cut_off_hz, recording.rate_hz)]
    if wrong:
        raise ValueError("\n".join(wrong))
    report = progress or (lambda *_: None)
    bodies = []
    for number, (name, take) in enumerate(zip(take_names(recording), recording.takes)):
        bodies.append(_seen(name, take, settings))
        report(number + 1, len(recording.takes), "jumps and gaps")
    left = [body for body in bodies if body.take is not None]
    left_out = tuple((body.name, body.repairs[-1].words) for body in bodies if body.take is None)
    if not left:
        raise ValueError("\n".join(["no take can be used:", *(f"take {name}: {why}" for name, why in left_out)]))
    left = _within_person(left, settings)
    for number, body in enumerate(left):
        left[number] = _finished(body, settings)
        report(number + 1, len(left), "angles and noise")
    found = {body.name: body.repairs for body in (*bodies, *left)}
    repairs = tuple(repair for body in bodies for repair in found[body.name])
    takes = tuple(body.left for body in left)
    after = replace(recording, takes=takes, notes=(*recording.notes, *notes(repairs, left_out)))
    return Cleaned(after, repairs, read, left_out)


@dataclass(frozen=True, eq=False)
class _Body:
    """A take on its way: its name, what is left of it (or None), what was found, frames cut off its start."""

    name: str
    take: Take | None
    repairs: tuple[Repair, ...] = ()
    cut_before: int = 0

    @property
    def left(self) -> Take:
        """The take of a body that was not left out."""
        assert self.take is not None
        return self.take

    def then(self, take: Take | None, repairs: tuple[Repair, ...]) -> _Body:
        """After a step: frames of what was found counted as in the take that was read."""
        named = tuple(
            replace(
                repair,
                take=self.name,
                first_frame=repair.first_frame + self.cut_before,
                last_frame=repair.last_frame + self.cut_before,
            )
            for repair in repairs
        )
        return replace(self, take=take, repairs=(*self.repairs, *named))


def _finite(take: Take) -> Take:
    """The take with each point either whole or not seen at all."""
    finite = np.isfinite(take.positions_m).all(axis=-1, keepdims=True)
    return take if finite.all() else replace(take, positions_m=np.where(finite, take.positions_m, np.nan))


def _seen(name: str, take: Take, settings: CleaningSettings) -> _Body:
    """With every joint in its place in every frame. Jumps are looked for again: one may hide another."""
    body = _Body(name, take).then(*without_swaps(take, settings))
    for _ in range(MOST_ROUNDS):
        calm, jumps = without_jumps(body.left, settings)
        body = body.then(calm, jumps)
        if settings.jumps != "mend" or not jumps:
            break
    whole, gaps = without_gaps(body.left, settings)
    before = [gap.last_frame + 1 for gap in gaps if gap.kind == "cut" and gap.first_frame == 0]
    return replace(body.then(whole, gaps), cut_before=max(before, default=0))


def _within_person(bodies: list[_Body], settings: CleaningSettings) -> list[_Body]:
    """Slips, bones, offsets and angles: what is told by a person's other takes."""
    done: dict[str, _Body] = {}
    for worker in dict.fromkeys(body.left.worker for body in bodies):
        own = [body for body in bodies if body.left.worker == worker]
        length_m = np.stack([median_lengths_m(body.left) for body in own])
        own = [_boned(body, np.delete(length_m, i, axis=0), settings) for i, body in enumerate(own)]
        offsets = without_offsets([body.left for body in own], settings)
        own = [body.then(*found) for body, found in zip(own, offsets)]
        neutral = neutral_angles([body.left for body in own])
        done |= {body.name: body.then(*within_limits(body.left, settings, neutral)) for body in own}
    return [done[body.name] for body in bodies]


def _boned(body: _Body, others_m: np.ndarray, settings: CleaningSettings) -> _Body:
    """others_m : (N, J) bone lengths of the person's other takes."""
    body = body.then(*without_slips(body.left, settings, np.median(others_m, axis=0) if len(others_m) else None))
    body = body.then(body.left, violent_steps(body.left, settings))
    return body.then(*with_even_bones(body.left, settings))


def _finished(body: _Body, settings: CleaningSettings) -> _Body:
    """Smooth, and with what is only told."""
    body = body.then(*smoothed(body.left, settings))
    too_fast = () if any(repair.bad for repair in body.repairs) else impossible(body.left)
    return body.then(body.left, (*too_fast, *told(body.left, settings)))


def notes(repairs: Sequence[Repair], left_out: Sequence[tuple[str, str]]) -> list[str]:
    """What the written recording says of its cleaning: how many of each kind were mended, and what was left out."""
    mended = [repair for repair in repairs if repair.mended]
    counts = [(kind, sum(repair.kind == kind for repair in mended)) for kind in KINDS]
    said = [f"cleaned: {', '.join(f'{n} x {kind}' for kind, n in counts if n)}"] if mended else []
    return [*said, *(f"left out {name}: {why}" for name, why in left_out)]

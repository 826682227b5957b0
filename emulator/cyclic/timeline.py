"""The latents of one performance from its first frame to its last, and where its beats lie: start, cycles, stop."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from emulator.cyclic.law import CyclicLaw, smoothed
from emulator.cyclic.switching_dynamics import TRIES as STEP_TRIES
from emulator.cyclic.units import FEWEST_FRAMES, ROOM, Unit, chosen, joined

PULLED = 0.6
TRIES = 4


@dataclass(frozen=True)
class Tempered:
    """A source of standard normal numbers made ``factor`` as large: see ``CyclicEmulator.temper``."""

    rng: np.random.Generator | None
    factor: float

    def standard_normal(self, shape: tuple[int, ...]) -> np.ndarray:
        return np.zeros(shape) if self.rng is None else self.factor * self.rng.standard_normal(shape)


@dataclass(frozen=True, eq=False)
class Timeline:
    """z (N, d) latents frame by frame, contact (N, 2), beat_frame (B,) rising, of which the first may be 0.

    given_up : how many beats are recorded ones, since the dynamics came to none
    """

    z: np.ndarray
    contact: np.ndarray
    beat_frame: np.ndarray
    given_up: int = 0

    def moved(self, offset: np.ndarray) -> Timeline:
        """With a worker's own offset (d,) in every frame."""
        return replace(self, z=self.z + offset)


def timeline(
    model: CyclicLaw, n_beats: int, control: float, first_foot: int, rng: np.random.Generator | None
) -> Timeline:
    """A draw with so many beats; ``rng`` None follows the mean."""
    start = chosen(model.starts or model.entries, first_foot, control)
    z, contact = (start.z, start.contact) if model.starts else (start.z[:1], start.contact[:1])
    foot, beats, given_up = start.foot, [len(z) - 1], 0
    for _ in range(n_beats - 1):
        more = one_beat(model, z[-2:], foot, control, rng)
        given_up += any(more is one for one in model.entries)
        z, contact = joined(z, more.z), np.concatenate([contact[:-1], more.contact])
        foot = 1 - foot if foot >= 0 else foot
        beats.append(len(z) - 1)
    if model.stops:
        stop = chosen(model.stops, foot, control, z[-1])
        z, contact = joined(z, stop.z), np.concatenate([contact[:-1], stop.contact])
    return Timeline(z, contact, np.array(beats), given_up)


def one_beat(model: CyclicLaw, z: np.ndarray, foot: int, control: float, rng: np.random.Generator | None) -> Unit:
    """From a beat to the next one, drawn from the dynamics; z (1 or 2, D) are the last latents, up to the beat.

    A draw begins some way back towards the usual posture of a beat at this speed (``PULLED``), so that a walk of a
    kilometre stays a walk. One that comes to no beat, or to an odd one, is drawn again (``TRIES``), then the mean is
    taken, then the nearest recorded beat: the predictive density, truncated to beats like the recorded ones.
    """
    usual = model.guide.usual(foot, control)
    begin = z[-1] + PULLED * (usual - z[-1])
    seen = model.seen(begin, begin - (z[-1] - z[0]))
    draw = _step if foot >= 0 else _cycle
    for source in [rng] * TRIES + [None] if rng is not None else [None]:
        found = draw(model, seen, foot, control, Tempered(source, model.temper))
        if found is not None:
            return found
    near = [one for one in model.entries if one.foot == foot] or list(model.entries)
    near = sorted(near, key=lambda one: abs(one.control - control))[:5]
    return near[0 if rng is None else int(rng.integers(len(near)))]


def _step(model: CyclicLaw, seen: np.ndarray, foot: int, control: float, source: Tempered) -> Unit | None:
    """A step of the other foot from what the dynamics see (d,) on; None where none like the recorded ones comes."""
    from emulator.kernels.switching import beat, made_whole
    from emulator.kernels.switching import usual as is_usual

    guide, dynamics, manner = model.guide, model.dynamics, model.manner
    usual_frames = guide.frames(control)
    n, known = int(1.6 * usual_frames) + 4, np.full(dynamics.n_controls, control)
    noise = source.standard_normal((n - 1, STEP_TRIES, dynamics.n_latents))
    z, state = np.empty((n, dynamics.n_latents)), np.empty(n, dtype=np.int64)
    z[0] = seen
    bears, beyond = manner.bears, len(manner.taps) // 2
    end, drawn = beat(
        dynamics.kernel_tables,
        known,
        noise,
        bears[:, 1 - foot],
        int(0.6 * usual_frames),
        beyond,
        FEWEST_FRAMES,
        z,
        state,
    )
    if end < 0 or not guide.lasts(end, control):
        return None
    moved = z[:drawn, : model.n_moved]
    after = guide.usual(1 - foot, control)
    if not is_usual(moved[: end + 1], manner.low, manner.high, after, ROOM * guide.apart):
        return None
    whole = np.empty((end + 1, model.latent.n_components))
    made_whole(moved, manner, known, whole)
    return Unit(whole, _clean(bears[state[: end + 1]], foot), control, foot)


def _cycle(model: CyclicLaw, seen: np.ndarray, foot: int, control: float, source: Tempered) -> Unit | None:
    """A cycle of work that is no walking, likewise."""
    drawn, state = model.dynamics.sample(
        seen[None],
        int(1.6 * model.guide.frames(control)) + 4,
        source,
        controls=np.array([[control]]) if model.dynamics.n_controls else None,
    )
    moved, low = drawn[0, :, : model.n_moved], int(0.6 * model.guide.frames(control))
    end = next((frame for frame in model.turns(moved) if frame > low), None)
    if end is None or not model.guide.allows(moved[: end + 1], foot, control):
        return None
    whole = model.whole(smoothed(moved), control)[: end + 1]
    return Unit(whole, model.contact_of(state[0])[: end + 1], control, foot)


def _clean(contact: np.ndarray, foot: int) -> np.ndarray:
    """From one beat to the next one foot bears, the other leaves the floor once and comes down in the last frame."""
    out, swings, n = np.ones((len(contact), 2), bool), 1 - foot, len(contact)
    up = np.flatnonzero(~contact[:, swings])
    leave = int(up[0]) if len(up) else n // 4
    out[min(max(leave, 2), n - 4) : n - 1, swings] = False
    return out

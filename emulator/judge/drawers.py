"""Who draws, fitted to the first half of recordings: our emulator, a scheme of the paper, and two controls."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from difflib import get_close_matches

import numpy as np

from emulator import model, schemes
from emulator.judge.alike import draw_alike
from emulator.judge.controls import jittered_resampler, resampler
from emulator.judge.halves import Halves
from emulator.judge.reconstruction import joint_reconstruction
from emulator.model import MotionEmulator
from emulator.schemes import Scheme
from emulator.schemes.names import parsed

RECORDED = "recordings: fitted half"
COPIER, SHAKER = "control: resampled", "control: jittered"
USUAL = (model.SCHEME, "SIEM/SequentialPCA/MVG")
KNOWN = tuple(dict.fromkeys((*model.SCHEMES, *schemes.SCHEMES)))
"""All names there are. Those of ``emulator.model`` are whole emulators, with durations and bodies; the others draw
postures on the common clock only."""

Sequences = Callable[[np.ndarray], np.ndarray]


@dataclass(frozen=True, eq=False)
class Drawer:
    """draw : (n, rng) -> sequences (n, T, B, 3) on the common clock; what it cannot do is None

    reconstruct    : sequences (n, T, B, 3) as its ``n_numbers`` components give them back
    log_likelihood : (n, T, B, 3) -> (n,) nats
    emulator       : where durations, marks and bodies come from
    """

    name: str
    draw: Callable[[int, np.random.Generator], np.ndarray]
    n_numbers: int | None = None
    reconstruct: Sequences | None = None
    log_likelihood: Sequences | None = None
    emulator: MotionEmulator | None = None


def kind(name: str) -> str:
    """recordings, control, emulator or scheme."""
    if name == RECORDED:
        return "recordings"
    if name in (COPIER, SHAKER):
        return "control"
    return "emulator" if name in model.SCHEMES else "scheme"


def unknown_names(names: Sequence[str]) -> list[str]:
    """What is wrong with each name that is not ``KNOWN``, with the nearest right word."""
    return [_unknown(name) for name in dict.fromkeys(names) if name not in KNOWN]


def drawer(name: str, halves: Halves) -> Drawer:
    """The drawer of this name, or the control, fitted to the first half. Raises ValueError where it cannot be."""
    if name == COPIER:
        return Drawer(name, lambda n, rng: resampler(halves.a, n, rng))
    if name == SHAKER:
        return Drawer(name, lambda n, rng: jittered_resampler(halves.a, n, rng))
    return _emulated(name, halves) if name in model.SCHEMES else _scheme(name, halves)


def _emulated(name: str, halves: Halves) -> Drawer:
    """Draws of the people of the fitted half, each as often as there."""
    ours = MotionEmulator.fit(halves.fitted, scheme=name, n_times=halves.a.shape[1], seed=halves.split)
    return Drawer(
        name,
        lambda n, rng: ours.aligned_directions(draw_alike(ours, halves.fitted, n, rng).scores),
        ours.posture.n_components,
        lambda sequences: joint_reconstruction(ours.flatten, ours.posture, sequences),
        emulator=ours,
    )


def _scheme(name: str, halves: Halves) -> Drawer:
    fitted = Scheme.fit(halves.a, name, seed=halves.split)
    return Drawer(name, fitted.sample, fitted.n_coefficients, fitted.reconstruct, fitted.log_likelihood)


def _unknown(name: str) -> str:
    """The nearest whole name where it is one of ours that the paper's parts do not know, else what parts are wrong."""
    folded = {known.lower(): known for known in model.SCHEMES}
    near = get_close_matches(name.lower(), folded, n=1, cutoff=0.9)
    if near:
        return f"scheme: no {name!r}; did you mean {folded[near[0]]!r}?"
    try:
        parsed(name)
    except ValueError as wrong:
        return str(wrong)
    return f"scheme: no {name!r}"

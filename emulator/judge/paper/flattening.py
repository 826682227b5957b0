"""What figures 4, 5, 7, 8, 9, 10 and 13 of the paper show: flattening and reduction of the recordings of a class."""

from __future__ import annotations

from typing import Any

import numpy as np

from emulator import sphere
from emulator.judge.disco import disco
from emulator.judge.distance import distances
from emulator.judge.energy import pooled
from emulator.judge.paper.prepared import PaperClass
from emulator.judge.reconstruction import reconstruction_error
from emulator.judge.streams import stream
from emulator.schemes import Scheme
from emulator.schemes.siem import SIEM
from emulator.schemes.velocity import ISTVF, MTVF, STVF

N_SHOWN = 3
SIZES = ((2, 4), (4, 4), (5, 4), (5, 10), (8, 10), (10, 10), (10, 20), (10, 30))
JOINT_SIZES = (4, 8, 12, 16, 20, 24, 28, 32, 36)
WIDTHS = (2, 4, 7, 10, 15, 20, 25, 30, 40)


def fields(c: PaperClass) -> dict[str, np.ndarray]:
    """Figure 4: the three liveliest channels (2, T', 3) of S-TVF and IS-TVF of two repetitions."""
    shown = {}
    kinds: dict[str, Any] = {"S-TVF": STVF, "IS-TVF": ISTVF}
    for name, kind in kinds.items():
        flat, _ = kind.fit(c.aligned).forward(c.aligned[:2])
        shown[name] = flat[..., np.argsort(flat.std(axis=(0, 1)))[::-1][:N_SHOWN]]
    return shown


def round_trip_errors(c: PaperClass) -> dict[str, np.ndarray]:
    """Figure 5: mean error (T,), radians summed over bones, of flattening and its way back.

    M-TVF comes back exactly if it goes back by the hops it came; by the one hop of definition 1 it drifts.
    """
    errors = {}
    kinds: dict[str, Any] = {"IS-TVF": ISTVF, "SIEM": SIEM, "M-TVF": MTVF}
    for name, kind in kinds.items():
        representation = kind.fit(c.aligned)
        again = representation.inverse(*representation.forward(c.aligned))
        errors[name] = sphere.distance(again, c.aligned).mean(axis=0)
    hops = MTVF.fit(c.aligned)
    again = hops.inverse_by_one_hop(*hops.forward(c.aligned))
    return errors | {"M-TVF, back in one hop": sphere.distance(again, c.aligned).mean(axis=0)}


def spatial_shares(c: PaperClass) -> dict[str, np.ndarray]:
    """Figure 7: share of the variance of each component in space."""
    found = {}
    kinds: dict[str, Any] = {"IS-TVF": ISTVF, "SIEM": SIEM}
    for name, kind in kinds.items():
        postures = kind.fit(c.aligned).forward(c.aligned)[0]
        values = np.linalg.eigvalsh(np.cov(postures.reshape(-1, postures.shape[-1]).T))[::-1]
        found[name] = values / values.sum()
    return found


def first_score(c: PaperClass) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Figure 8: the first spatial score of SIEM (N, T), its first functions of time (3, T), and all their shares."""
    flat = SIEM.fit(c.aligned).forward(c.aligned)[0]
    centred = (flat - flat.reshape(-1, flat.shape[-1]).mean(axis=0)).reshape(-1, flat.shape[-1])
    first = np.linalg.eigh(centred.T @ centred)[1][:, -1]
    scores = (centred @ first).reshape(flat.shape[:2])
    _, values, functions = np.linalg.svd(scores - scores.mean(axis=0), full_matrices=False)
    return scores, functions[:N_SHOWN], values**2 / np.sum(values**2)


def errors_by_size(c: PaperClass) -> dict[str, tuple[list[int], list[float]]]:
    """Figure 9: numbers a sequence, and the error (eq. 5) of the fitted sequences, for each reduction."""
    most = len(c.aligned) - 1
    pairs = list(dict.fromkeys((d1, min(d2, most)) for d1, d2 in SIZES))
    joint = [size for size in JOINT_SIZES if size <= most]
    tried: dict[str, Any] = {"SequentialPCA": pairs, "MPCA": pairs, "JointPCA": joint}
    found = {}
    for reduction, sizes in tried.items():
        errors = [_error(c, f"SIEM/{reduction}/MVG", size) for size in sizes]
        found[reduction] = [s if isinstance(s, int) else s[0] * s[1] for s in sizes], errors
    return found


def first_coefficients(c: PaperClass) -> np.ndarray:
    """Figure 10: coefficients (N, 2, 4) of SIEM/SequentialPCA: two spatial scores, four functions each."""
    scores = Scheme.fit(c.aligned, "SIEM/SequentialPCA/MVG", (5, 4)).coefficients
    return scores[:, :8].reshape(-1, 2, 4)


def dimensions(c: PaperClass) -> tuple[list[int], dict[int, list[float]], list[float]]:
    """Figure 13: d2, errors for d1 = 5 and 10, and p of reconstructed against original sequences for d1 = 10."""
    widths = [width for width in WIDTHS if width < len(c.aligned)]
    again = {
        d1: [Scheme.fit(c.aligned, "SIEM/SequentialPCA/MVG", (d1, d2)).reconstruct(c.aligned) for d2 in widths]
        for d1 in (5, 10)
    }
    errors = {d1: [reconstruction_error(c.aligned, sequences) for sequences in made] for d1, made in again.items()}
    among, rng = distances(c.aligned), stream(c.seed, c.task, "figure 13")
    tested = [pooled(distances(sequences, c.aligned), distances(sequences), among) for sequences in again[10]]
    return widths, errors, [disco(both, len(c.aligned), rng).p for both in tested]


def _error(c: PaperClass, name: str, size: Any) -> float:
    return reconstruction_error(c.aligned, Scheme.fit(c.aligned, name, size).reconstruct(c.aligned))

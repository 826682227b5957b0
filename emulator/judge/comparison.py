"""All cheap judges of postures at once: drawn sequences against real ones that were not used for the fit.

Controls: drawers that a good set of judges must see through.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from emulator.geometry.flattening import SIEM
from emulator.judge.posture_tests import disco, novelty, roughness, temporal_roughness
from emulator.judge.sequence_distances import distances, energy_stratified, energy_u, pooled
from emulator.model.reduction import JointPCA


@dataclass(frozen=True)
class Comparison:
    """How drawn sequences stand beside unseen real ones; read all together, for a copier passes the first three.

    energy            : U-statistic, around 0 for one law
    energy_stratified : the same where people were dealt out evenly (see ``energy_stratified``); NaN without strata
    p                 : of DISCO, with as many drawn as unseen
    novelty, temporal_roughness (of the paper), roughness (second differences) : ratios, emulated over unseen
    """

    energy: float
    energy_stratified: float
    p: float
    novelty: float
    temporal_roughness: float
    roughness: float


def compare(
    drawn: np.ndarray,
    few: np.ndarray,
    training: np.ndarray,
    unseen: np.ndarray,
    rng: np.random.Generator,
    strata: np.ndarray | None = None,
    drawn_strata: np.ndarray | None = None,
) -> Comparison:
    """Judge many drawn sequences (n, T, B, 3), and for DISCO a ``few`` more, as many as unseen; one common clock.

    strata, drawn_strata : number of the person of each unseen (and each drawn) sequence, where these were dealt out
    """
    to_unseen, among_unseen = distances(drawn, unseen), distances(unseen)
    tested = pooled(distances(few, unseen), distances(few), among_unseen)
    apart = (to_unseen, distances(drawn), among_unseen)
    return Comparison(
        energy_u(*apart),
        float("nan") if strata is None else energy_stratified(*apart, strata, drawn_strata),
        disco(tested, len(few), rng).p,
        novelty(distances(drawn, training), distances(unseen, training)),
        temporal_roughness(drawn) / temporal_roughness(unseen),
        roughness(drawn) / roughness(unseen),
    )


JITTER = 0.2


def resampler(training: np.ndarray, n: int, rng: np.random.Generator) -> np.ndarray:
    """n of the training sequences (N, T, B, 3), drawn with replacement: right in law, new in nothing."""
    return training[rng.integers(len(training), size=n)]


def jittered_resampler(training: np.ndarray, n: int, rng: np.random.Generator, jitter: float = JITTER) -> np.ndarray:
    """The same with a little Gaussian noise: ``jitter`` of the spread of each of all joint components.

    training (N, T, B, 3) on a common clock -> (n, T, B, 3).
    """
    siem = SIEM.fit(training)
    flat = siem.forward(training).reshape(len(training), -1)
    pca = JointPCA.fit(flat, 0.999999)
    scores = pca.forward(flat)
    noise = jitter * scores.std(axis=0, ddof=1) * rng.standard_normal((n, pca.n_components))
    drawn = pca.inverse(scores[rng.integers(len(scores), size=n)] + noise)
    return siem.inverse(drawn.reshape(n, training.shape[1], siem.n_channels))

"""All cheap judges of postures at once: drawn sequences against real ones that were not used for the fit."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from emulator.judge.disco import disco
from emulator.judge.distance import distances
from emulator.judge.energy import energy_stratified, energy_u, pooled
from emulator.judge.novelty import novelty
from emulator.judge.roughness import roughness, temporal_roughness


@dataclass(frozen=True)
class Comparison:
    """How drawn sequences stand beside unseen real ones; read all together, for a copier passes the first three.

    energy            : U-statistic, around 0 for one law
    energy_stratified : the same where people were dealt out evenly (see ``energy_stratified``); NaN without strata
    p                 : of DISCO, with as many drawn as unseen
    novelty, temporal_roughness (of [000]), roughness (second differences) : ratios, emulated over unseen
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

import numpy as np

from emulator.judge import (
    compare,
    disco,
    distances,
    energy_u,
    jittered_resampler,
    novelty,
    pooled,
    resampler,
    roughness,
)
from tests.emulator.judge.made import sequences

ALL = sequences(420, 9, 3, 0.2)
TRAINING, UNSEEN, FEW, DRAWN = ALL[:40], ALL[40:80], ALL[80:120], ALL[120:]


def judged(drawn, few, **more):
    return compare(drawn, few, TRAINING, UNSEEN, np.random.default_rng(0), **more)


def test_sequences_of_the_same_law_pass_every_judge():
    found = judged(DRAWN, FEW)
    assert abs(found.energy) < 0.03 * distances(UNSEEN).mean()
    assert found.p > 0.05 and 0.85 < found.novelty < 1.15 and 0.9 < found.roughness < 1.1
    assert np.isnan(found.energy_stratified)


def test_a_copier_passes_energy_and_disco_and_fails_novelty():
    rng = np.random.default_rng(1)
    found = judged(resampler(TRAINING, 300, rng), resampler(TRAINING, 40, rng))
    assert found.p > 0.05 and found.novelty == 0
    shaken = judged(jittered_resampler(TRAINING, 300, rng), jittered_resampler(TRAINING, 40, rng))
    assert shaken.novelty < 0.8


def test_another_law_fails_energy_and_disco():
    other = sequences(420, 9, 3, 0.35)
    found = judged(other[120:], other[80:120])
    assert found.energy > 0.05 * distances(UNSEEN).mean() and found.p < 0.05 and found.novelty > 1.25


def test_comparing_is_asking_each_judge():
    found = judged(DRAWN, FEW, strata=np.zeros(40, int))
    tested = pooled(distances(FEW, UNSEEN), distances(FEW), distances(UNSEEN))
    assert found.energy == energy_u(distances(DRAWN, UNSEEN), distances(DRAWN), distances(UNSEEN))
    assert np.isclose(found.energy_stratified, found.energy)
    assert found.p == disco(tested, 40, np.random.default_rng(0)).p
    assert found.novelty == novelty(distances(DRAWN, TRAINING), distances(UNSEEN, TRAINING))
    assert found.roughness == roughness(DRAWN) / roughness(UNSEEN)

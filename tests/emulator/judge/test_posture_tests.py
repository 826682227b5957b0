import json
from itertools import combinations

import numpy as np
import pytest

from emulator.judge import disco, energy_of_size, energy_stratified, energy_u, energy_v, pooled
from emulator.judge.comparison import resampler
from emulator.judge.held_out import COPIER, KNOWN, RECORDED, SHAKER, USUAL, drawer, kind, unknown_names
from emulator.judge.posture_tests import reconstruction_error
from emulator.schemes import SCHEMES, Scheme
from tests.emulator.judge.halved import drawn_by, halves
from tests.emulator.judge.made import parts, plain_distances
from tests.recordings import reference


def test_a_case_by_hand():
    """{0, 1} against {3, 4}: e = 2 * 3 - 1/2 - 1/2; S = (4 / 8) e = 2.5, W = 1/2 + 1/2 with one half a sample."""
    points = np.array([[0.0], [1.0], [3.0], [4.0]])
    found = disco(plain_distances(points, points), 2, np.random.default_rng(0))
    assert found.energy == 5.0
    assert np.isclose(found.f, 2.5 / (1.0 / (4 - 2)))
    # two of the six divisions ({01|34} and its mirror) are as far apart
    assert abs(found.p - 1 / 3) < 0.05


def test_the_statistic_is_the_energy_distance_and_permutations_are_those_of_the_definition():
    x, y = np.random.default_rng(3).normal(size=(2, 4, 2)) + np.array([0.0, 0.6])[:, None, None]
    d = pooled(*parts(x, y))
    of_all = []
    for first in combinations(range(8), 4):
        rest = [i for i in range(8) if i not in first]
        of_all.append(energy_v(d[np.ix_(first, rest)], d[np.ix_(first, first)], d[np.ix_(rest, rest)]))
    found = disco(d, 4, np.random.default_rng(0), 20_000)
    assert np.isclose(found.energy, of_all[0])
    assert abs(found.p - np.mean(np.array(of_all) >= of_all[0] - 1e-12)) < 0.015


def test_f_and_energy_order_divisions_alike():
    d = pooled(*parts(*np.random.default_rng(4).normal(size=(2, 6, 2))))
    orders = [np.random.default_rng(i).permutation(12) for i in range(30)]
    found = [disco(d[np.ix_(o, o)], 6, np.random.default_rng(0), 1) for o in orders]
    assert np.array_equal(np.argsort([f.energy for f in found]), np.argsort([f.f for f in found]))


def test_p_is_uniform_where_both_samples_are_of_one_law():
    from scipy.stats import kstest

    rng = np.random.default_rng(5)
    p = [disco(pooled(*parts(*rng.normal(size=(2, 15, 3)))), 15, rng, 199).p for _ in range(500)]
    assert kstest(p, "uniform").pvalue > 0.01
    assert 0.03 < np.mean(np.array(p) <= 0.05) < 0.075


@pytest.mark.parametrize("other", ["shifted", "wider"])
def test_another_mean_or_spread_is_seen(other):
    rng = np.random.default_rng(6)
    change = {"shifted": lambda y: y + 0.8, "wider": lambda y: 3.0 * y}[other]
    p = [disco(pooled(*parts(x, change(y))), 30, rng, 199).p for x, y in rng.normal(size=(40, 2, 30, 3))]
    assert np.mean(np.array(p) < 0.05) > 0.9


def test_p_is_never_zero():
    far = pooled(*parts(np.zeros((20, 1)) + np.arange(20)[:, None] * 1e-3, np.full((20, 1), 9.0)))
    assert disco(far, 20, np.random.default_rng(0), 99).p == 0.01


def test_an_empty_sample_is_refused():
    with pytest.raises(ValueError, match="expected 1 to 4"):
        disco(np.zeros((5, 5)), 5, np.random.default_rng(0))


def test_energy_is_dcors():
    case = json.loads(reference("emulator_oracles.json").read_text())["energy_dcor"]
    assert np.isclose(energy_v(*parts(np.array(case["A"]), np.array(case["B"]))), case["dcor"], rtol=1e-13)


def test_two_points_against_two_points():
    """{0, 2} against {1, 5} on a line: distances 1, 5, 1, 3 between, 2 and 4 among."""
    given = parts(np.array([[0.0], [2.0]]), np.array([[1.0], [5.0]]))
    assert energy_u(*given) == 2 * (1 + 5 + 1 + 3) / 4 - 2 - 4
    assert energy_v(*given) == 2 * (1 + 5 + 1 + 3) / 4 - 1 - 2


def test_the_u_statistic_is_unbiased_and_the_v_statistic_is_not():
    rng = np.random.default_rng(0)
    drawn = [parts(rng.normal(size=(10, 2)), rng.normal(size=(12, 2))) for _ in range(800)]
    u, v = (np.array([energy(*d) for d in drawn]) for energy in (energy_u, energy_v))
    assert abs(u.mean()) < 3 * u.std() / np.sqrt(len(u)) and np.any(u < 0)
    assert v.min() > 0


def people(rng, each, n_people=5):
    """A sample with ``each`` items of each of five people who differ."""
    return np.repeat(np.linspace(-4, 4, n_people), each)[:, None] + rng.normal(size=(n_people * each, 1))


def test_people_dealt_out_evenly_bias_the_u_statistic_and_not_the_stratified_one():
    rng = np.random.default_rng(1)
    strata = np.repeat(np.arange(5), 4)
    drawn = [parts(people(rng, 4), people(rng, 4)) for _ in range(400)]
    stratified = np.array([energy_stratified(*d, strata, strata) for d in drawn])
    assert abs(stratified.mean()) < 3 * stratified.std() / np.sqrt(len(stratified))
    assert np.mean([energy_u(*d) for d in drawn]) < -0.2


def test_one_stratum_is_no_stratification():
    given = parts(*np.random.default_rng(2).normal(size=(2, 9, 3)))
    assert np.isclose(energy_stratified(*given, np.zeros(9, int), None), energy_u(*given))


def test_a_person_with_one_repetition_is_given_the_others_spread():
    given = parts(np.array([[0.0], [1.0]]), np.array([[0.0], [2.0], [7.0]]))
    among_b = (2 / 3) ** 2 * 2 + (1 / 3) ** 2 * 2 + 2 * (2 / 9) * 6
    assert np.isclose(energy_stratified(*given, np.array([0, 0, 1]), None), 2 * given[0].mean() - 1 - among_b)


def test_the_energy_of_a_size_is_the_v_statistic_of_samples_of_that_size():
    x, y = np.random.default_rng(3).normal(size=(2, 12, 3))
    assert np.isclose(energy_of_size(*parts(x, y), 12), energy_v(*parts(x, y)))
    rng = np.random.default_rng(4)
    few = [energy_v(*parts(rng.choice(x, 5), y)) for _ in range(4000)]
    again = parts(np.repeat(x, 60, axis=0), y)
    assert abs(energy_of_size(*again, 5) - np.mean(few)) < 3 * np.std(few) / np.sqrt(4000)


def test_the_energy_of_a_size_allows_for_people_dealt_out_evenly():
    """Against independent items, which people dealt out evenly stand for: else it would be too small."""
    rng = np.random.default_rng(5)
    strata = np.repeat(np.arange(5), 4)
    dealt = [parts(people(rng, 4), people(rng, 4)) for _ in range(300)]
    free = [parts(*(rng.choice(np.linspace(-4, 4, 5), (2, 20, 1)) + rng.normal(size=(2, 20, 1)))) for _ in range(300)]
    fair = np.array([energy_of_size(*d, 20, strata, strata) for d in dealt])
    independent = np.array([energy_v(*d) for d in free])
    assert abs(fair.mean() - independent.mean()) < 3 * independent.std() / np.sqrt(300)
    assert np.mean([energy_v(*d) for d in dealt]) < 0.7 * independent.mean()


def test_where_everybody_has_one_repetition_all_are_independent():
    given = parts(*np.random.default_rng(6).normal(size=(2, 9, 3)))
    assert np.isclose(energy_stratified(*given, np.arange(9), np.arange(9)), energy_u(*given))


def test_pooled_puts_the_first_sample_first():
    between, among_a, among_b = parts(np.zeros((2, 1)), np.ones((3, 1)))
    assert pooled(between, among_a, among_b).sum() == 12 and pooled(between, among_a, among_b)[0, 2] == 1


def test_one_item_has_no_u_statistic():
    with pytest.raises(ValueError, match="at least 2"):
        energy_u(*parts(np.zeros((1, 1)), np.zeros((3, 1))))


def test_all_schemes_of_the_paper_and_ours_have_a_name():
    assert set(SCHEMES) < set(KNOWN) and set(USUAL) <= set(KNOWN)
    assert unknown_names(KNOWN) == []


def test_names_of_emulators_mean_the_emulator_and_others_the_scheme():
    assert [kind(n) for n in ("SIEM/JointPCA/MVG", *USUAL)] == ["emulator", "emulator", "scheme"]
    assert [kind(n) for n in (RECORDED, COPIER, SHAKER)] == ["recordings", "control", "control"]


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("SIEM/JointPCA/Smothed", "did you mean 'SIEM/JointPCA/Smoothed'?"),
        ("siem/jointpca/smoothed", "did you mean 'SIEM/JointPCA/Smoothed'?"),
        ("SIEM/SequentialPCA/MGV", "no 'MGV', did you mean 'MVG'?"),
        ("SIEM/SequentialPCA/VAR", "VAR does not go with SequentialPCA, which goes with MVG, IG, Kernel"),
        ("PWJ", "did you mean 'PWI'?"),
        ("", "expected Representation/DimensionReduction/Model"),
    ],
)
def test_a_wrong_name_is_told_with_the_nearest_right_one(name, words):
    (said,) = unknown_names([name])
    assert words in said and repr(name) in said


def test_all_wrong_names_are_told_each_once():
    assert len(unknown_names(["PWJ", "PWI", "nobody", "PWJ"])) == 2


@pytest.mark.parametrize("name", [*USUAL, COPIER, SHAKER])
def test_every_drawer_draws_sequences_on_the_clock_and_the_same_seed_gives_the_same(name):
    one = drawn_by(name)
    drawn, again = (one.draw(7, np.random.default_rng(2)) for _ in range(2))
    assert drawn.shape == (7, *halves().a.shape[1:]) and np.array_equal(drawn, again)
    assert np.allclose(np.linalg.norm(drawn, axis=-1), 1)


def test_ours_has_an_emulator_and_a_scheme_a_likelihood():
    ours, paper = (drawn_by(name) for name in USUAL)
    assert ours.emulator is not None and ours.log_likelihood is None
    assert paper.emulator is None and paper.log_likelihood(halves().b).shape == (12,)
    for one in (ours, paper):
        assert reconstruction_error(halves().b, one.reconstruct(halves().b)) < 0.2


def test_a_scheme_is_that_of_the_fitted_half():
    expected = Scheme.fit(halves().a, "PWI/shared", seed=3).sample(4, np.random.default_rng(1))
    assert np.array_equal(drawer("PWI/shared", halves()).draw(4, np.random.default_rng(1)), expected)


def test_the_copier_copies_the_fitted_half():
    drawn = drawer(COPIER, halves()).draw(9, np.random.default_rng(0))
    assert np.array_equal(drawn, resampler(halves().a, 9, np.random.default_rng(0)))

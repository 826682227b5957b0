import json

import numpy as np
import pytest

from emulator.judge import energy_of_size, energy_stratified, energy_u, energy_v, pooled
from tests.emulator.judge.made import parts
from tests.recordings import reference


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

import numpy as np

from emulator.cleaning.spikes import largest_beside, surprise_m, surprise_vectors_m


def way(values):
    return np.array(values, float)[:, None, None] * np.array([1.0, 0.0, 0.0])


def test_an_even_speed_is_no_surprise_and_an_even_acceleration_is_none_but_at_the_ends():
    t = np.arange(10.0)
    assert np.allclose(surprise_m(way(3 * t)), 0) and np.allclose(surprise_m(way(t**2))[1:-1], 0)


def test_a_step_surprises_by_its_size_and_by_half_beside_it():
    found = surprise_vectors_m(way([0, 0, 0, 0, 2, 2, 2, 2]))[:, 0, 0]
    assert np.allclose(found, [0, 0, -1, 2, -1, 0, 0])


def test_a_spike_surprises_by_one_and_a_half_there_and_back():
    found = surprise_vectors_m(way([0, 0, 0, 0, 2, 0, 0, 0, 0]))[:, 0, 0]
    assert np.allclose(found, [0, 0, -1, 3, -3, 1, 0, 0])


def test_beside_what_was_not_seen_nothing_surprises():
    values = way([0, 0, 0, np.nan, 5, 5, 5, 5])
    assert np.all(surprise_m(values) == 0)


def test_the_largest_beside_looks_at_both_neighbours():
    assert largest_beside(np.array([1.0, 3.0, 2.0])).tolist() == [3.0, 2.0, 3.0]

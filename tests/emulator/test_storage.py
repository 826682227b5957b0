import numpy as np
import pytest

from emulator.model.joint_coordinates import bits, decode, encode, on_grid


def rows():
    return np.random.default_rng(0).normal(size=(5, 300)) * np.array([[1e-9], [1.0], [3e4], [0.5], [0.0]])


@pytest.mark.parametrize("n_bits", [15, 19, 24])
def test_rounding_to_the_grid_twice_is_rounding_once(n_bits):
    once = on_grid(rows(), n_bits)
    assert np.array_equal(on_grid(once, n_bits), once)


@pytest.mark.parametrize("n_bits", [15, 19, 24])
def test_the_grid_is_as_fine_as_its_bits(n_bits):
    largest = np.abs(rows()).max(axis=1, keepdims=True)
    assert np.all(np.abs(on_grid(rows(), n_bits) - rows()) <= largest * 2.0**-n_bits * 1.01)


@pytest.mark.parametrize(("n_bits", "kind"), [(15, np.int16), (19, np.int32)])
def test_encoded_rows_come_back_exactly(n_bits, kind):
    grid = on_grid(rows(), n_bits)
    whole, exponent = encode(grid, n_bits)
    assert whole.dtype == kind
    assert np.array_equal(decode(whole, exponent), grid)


def test_more_points_get_more_bits_as_their_second_differences_need():
    assert [bits(n) for n in (10, 101, 201, 301, 10**6)] == [15, 15, 17, 19, 30]


def test_the_grid_does_not_show_in_the_second_differences_of_many_points():
    clock = np.linspace(0, 1, 301)
    smooth = np.sin(2 * np.pi * clock)[None]
    bent = [np.diff(x, n=2).std() for x in (smooth, on_grid(smooth, bits(301)) - smooth, on_grid(smooth, 15) - smooth)]
    assert bent[1] < 0.03 * bent[0] < bent[2]

import numpy as np

from emulator.storage import decode, encode, on_grid


def rows():
    return np.random.default_rng(0).normal(size=(5, 300)) * np.array([[1e-9], [1.0], [3e4], [0.5], [0.0]])


def test_rounding_to_the_grid_twice_is_rounding_once():
    once = on_grid(rows())
    assert np.array_equal(on_grid(once), once)


def test_the_grid_is_fine():
    assert np.all(np.abs(on_grid(rows()) - rows()) <= np.abs(rows()).max(axis=1, keepdims=True) / 32000)


def test_encoded_rows_are_16_bits_and_come_back_exactly():
    grid = on_grid(rows())
    whole, exponent = encode(grid)
    assert whole.dtype == np.int16
    assert np.array_equal(decode(whole, exponent), grid)

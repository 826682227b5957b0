"""Long arrays on a binary grid: 16 bits a number, so that a saved model is the fitted one to the last bit."""

from __future__ import annotations

import numpy as np


def on_grid(rows: np.ndarray) -> np.ndarray:
    """rows (R, P) rounded to multiples of a power of two a row, at most 32767 of them; again, it changes nothing."""
    whole, exponent = encode(rows)
    return decode(whole, exponent)


def encode(rows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """rows (R, P) -> int16 (R, P) and exponents int16 (R,)."""
    largest = np.maximum(np.abs(rows).max(axis=1, initial=0.0), 1e-30)
    exponent = np.ceil(np.log2(largest / 32767.0)).astype(np.int16)
    return np.rint(np.ldexp(rows, -exponent[:, None].astype(int))).astype(np.int16), exponent


def decode(whole: np.ndarray, exponent: np.ndarray) -> np.ndarray:
    """The way back: float64 (R, P). Raises ValueError for an exponent that no row of finite numbers has."""
    if exponent.dtype != np.int16 or np.any(np.abs(exponent.astype(int)) > 1000):
        raise ValueError(f"exponents must be int16 from -1000 to 1000, found {exponent.dtype}")
    return np.ldexp(whole.astype(float), exponent[:, None].astype(int))

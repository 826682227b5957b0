"""Whole numbers that change smoothly, as bytes that pack well: what a library's curves are written as.

Second differences along time are small; folded, so that small negative ones are small too (the zigzag of Protocol
Buffers), their high bytes are nearly all 0, and stand together.
"""

from __future__ import annotations

import numpy as np


def to_planes(whole: np.ndarray) -> np.ndarray:
    """Whole numbers of 16 or 32 bits (..., T) -> their bytes (2 or 4, ..., T), the lowest plane first."""
    size = whole.dtype.itemsize
    steps = whole.view(f"u{size}")
    for _ in range(2):  # modulo 2^16 or 2^32: nothing is lost
        steps = np.diff(steps, axis=-1, prepend=np.zeros((*steps.shape[:-1], 1), steps.dtype))
    sign = (steps.view(f"i{size}") >> (8 * size - 1)).view(steps.dtype)
    folded = (steps << 1) ^ sign
    return np.stack([(folded >> (8 * byte)).astype(np.uint8) for byte in range(size)])


def from_planes(planes: np.ndarray) -> np.ndarray:
    """The way back, exactly. Raises ValueError for what are no bytes of 16 or 32 bits."""
    size = len(planes)
    if planes.dtype != np.uint8 or size not in (2, 4):
        raise ValueError(f"planes are {size} of {planes.dtype}, expected 2 or 4 of uint8")
    folded = np.zeros(planes.shape[1:], f"u{size}")
    for byte in range(size):
        folded |= planes[byte].astype(folded.dtype) << (8 * byte)
    steps = (folded >> 1) ^ -(folded & 1)
    for _ in range(2):
        steps = np.cumsum(steps, axis=-1, dtype=steps.dtype)
    return steps.view(f"i{size}")

"""Random numbers of their own for each name, so that no part's numbers depend on another part."""

from __future__ import annotations

from hashlib import blake2b

import numpy as np


def stream(seed: int, *name: str) -> np.random.Generator:
    """The generator of one named thing, e.g. ``stream(7, "deep_squat", "PWI")``."""
    words = (int.from_bytes(blake2b(part.encode(), digest_size=8).digest(), "big") for part in name)
    return np.random.default_rng([seed, *words])

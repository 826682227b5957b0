"""What may be known of a worker's body: the names that reach ``draw_worker(rng, body)``, and what people can be."""

from __future__ import annotations

from typing import Any

BODY_RANGES: dict[str, tuple[float, float]] = {
    "height_m": (0.9, 2.4),
    "mass_kg": (25.0, 300.0),
    "age_years": (5.0, 110.0),
    "pace": (0.3, 3.0),
}
"""Smallest and largest; beyond them is a slip of the pen or of the unit. The emulator's own; a test compares them."""
BODY_KEYS = ("height_m", "mass_kg", "age_years", "sex", "pace", "person")
"""pace: 1.1 is a tenth faster than the typical person in emulated tasks; person: the name of a recorded one."""


def keys_read(model: Any) -> tuple[str, ...]:
    """What a task model reads of a body: its ``body_keys``; of a model that does not say, anything may be read."""
    return tuple(getattr(model, "body_keys", BODY_KEYS))

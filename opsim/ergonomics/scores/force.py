"""Loads in kilograms, in both hands together, as the methods count them."""

from __future__ import annotations

from opsim.plan.handling import FORCES
from opsim.problems import did_you_mean, shown

RULES = ("paper", "worksheet")


def rula_force(load_kg: float, pattern: str = "intermittent", rule: str = "paper") -> int:
    """RULA's force score: 0 less than 2 kg; 1 from 2 to 10 kg now and then; 2 from 2 to 10 kg static or repeated, or
    more than 10 kg now and then; 3 more than 10 kg static or repeated, or a shock of any size.

    pattern : ``intermittent``, ``repeated``, ``static`` or ``shock``
    rule    : ``paper``, or ``worksheet``, by which more than 10 kg is always 3
    Raises ValueError for an unknown word, with the nearest. Source: McAtamney & Corlett 1993, fig. 6.
    """
    _known("force", pattern, FORCES)
    _known("rule of force", rule, RULES)
    if pattern == "shock":
        return 3
    if load_kg < 2:
        return 0
    if load_kg > 10 and rule == "worksheet":
        return 3
    return 1 + (load_kg > 10) + (pattern != "intermittent")


def reba_load(load_kg: float, *, shock: bool = False) -> int:
    """REBA's load or force score: 0 less than 5 kg, 1 to 10 kg, 2 above; 1 more for a shock or rapid build up.

    Source: Hignett & McAtamney 2000, table A's load.
    """
    return (load_kg >= 5) + (load_kg > 10) + bool(shock)


def owas_load(load_kg: float) -> int:
    """OWAS's fourth digit: 1 to 10 kg, 2 to 20 kg, 3 above. Source: Karhu, Kansi & Kuorinka 1977."""
    return 1 + (load_kg > 10) + (load_kg > 20)


def _known(what: str, word: str, words: tuple[str, ...]) -> None:
    if word not in words:
        raise ValueError(f"no {what} {shown(word)}; {did_you_mean(word, words)}")

"""Variants of one run that differ in nothing but what varies in them: in ``run: variability``."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

from opsim.study.folder import RESOLVED

FULL = "full"
_SWITCH = re.compile(r"(?<![\w.])variability: ?(full|within_only|between_only|none|shuffled),? ?")


def switched_variants(siblings: Mapping[str, Any], here: str) -> dict[str, str]:
    """Switch -> variant, of those that are else the same scenario as ``here``, none where it is not among them.

    siblings : Results by name. Raises OSError where a resolved scenario cannot be read.
    """
    if here not in siblings:
        return {}
    read = {name: _read(result) for name, result in siblings.items()}
    switch, text = read[here]
    found = {switch: here}
    for name, (other, its_text) in read.items():
        if its_text == text:
            found.setdefault(other, name)
    return found


def _read(result: Any) -> tuple[str, str]:
    """The switch of a variant, and its scenario without it, so that two can be compared."""
    text = (result.folder / RESOLVED).read_text(encoding="utf-8")
    plain = re.sub(r"\s+", " ", text)
    switches = _SWITCH.findall(plain)
    left = re.sub(r",? ?}", "}", _SWITCH.sub("", plain))
    return (switches[0] if switches else FULL), left

"""Natural order of names: w2 before w10, so that the order of declaration decides nothing; and names in a sentence."""

import re
from collections.abc import Iterable, Sequence
from functools import lru_cache

_DIGITS = re.compile(r"(\d+)")


@lru_cache(maxsize=8192)
def natural_key(name: str) -> tuple:
    """Sort key of a name with its numbers read as numbers; the name itself breaks ties such as ``w1`` and ``w01``."""
    parts = _DIGITS.split(name)
    return (*((int(part), "") if part.isdecimal() else (-1, part) for part in parts), (-2, name))


def listed(words: Iterable[str]) -> str:
    """Words with commas between them, the first seven of many."""
    words = list(words)
    return ", ".join(words) if len(words) <= 8 else ", ".join(words[:7]) + f" and {len(words) - 7} more"


def enumerated(names: Sequence[str]) -> str:
    """``a``, ``a and b``, ``a, b and c``; of more than six the first five."""
    if len(names) == 1:
        return names[0]
    shown = list(names) if len(names) <= 6 else [*names[:5], f"{len(names) - 5} more"]
    return f"{', '.join(shown[:-1])} and {shown[-1]}"

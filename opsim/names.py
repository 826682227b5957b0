"""Natural order of names: w2 before w10, so that the order of declaration decides nothing."""

import re

_DIGITS = re.compile(r"(\d+)")


def natural_key(name: str) -> tuple:
    """Sort key of a name with its numbers read as numbers; the name itself breaks ties such as ``w1`` and ``w01``."""
    parts = _DIGITS.split(name)
    return (*((int(part), "") if part.isdecimal() else (-1, part) for part in parts), (-2, name))

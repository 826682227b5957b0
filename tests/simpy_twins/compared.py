"""Rows of a twin beside those of an engine; and a twin's scenario with all that is random in whole seconds."""

import re

import numpy as np
from simpy_twins.floor import Row

from opsim.log import EventLog


def rows_of(log: EventLog) -> list[Row]:
    """All rows of a log, of any kind, as the twins write them."""

    def column(name: str) -> list:
        if name in log.names:
            return np.array([*log.names[name], ""], dtype=object)[log[name]].tolist()
        return np.nan_to_num(log[name], nan=-1.0).tolist()

    return list(map(Row, *map(column, Row._fields)))


def first_difference(found: list[Row], expected: list[Row]) -> str:
    """The first row that only one of them has, in words; nothing where both have the same rows."""
    only = sorted([(row, "only the twin has") for row in set(found) - set(expected)])
    only += sorted([(row, "only the engine has") for row in set(expected) - set(found)])
    if only:
        row, whose = min(only)
        return f"{whose} {row} ({len(only)} of {len(found)} and {len(expected)} rows differ)"
    return "" if sorted(found) == sorted(expected) else "a row stands there more often than in the other"


def whole_seconds(text: str) -> str:
    """A scenario with all its random times geometric, in whole seconds: much of it happens at one instant."""

    def of_mean(match: re.Match) -> str:
        low_s, high_s = (float(found) for found in match.groups())
        return f"dist: geometric, mean: {(low_s + high_s) / 2} s, step: 1 s"

    text = re.sub(r"dist: uniform, low: (\d+) s, high: (\d+) s", of_mean, text)
    text = re.sub(r"dist: exponential, (mean: \d+ s)", r"dist: geometric, \1, step: 1 s", text)
    return re.sub(r"poisson, every: (\d+ \w+)", r"renewal, every: {dist: geometric, mean: \1, step: 1 s}", text)

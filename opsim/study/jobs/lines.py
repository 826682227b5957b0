"""The lines of a journal: JSON lists that end with their own checksum, so that a damaged one is known as such."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from typing import Any
from zlib import crc32

CHECK = len(', "01234567"]')


class Damaged(ValueError):
    """A line that is not what was written."""


def to_line(values: Sequence[Any]) -> bytes:
    """A list of plain values as one line; floats exactly, by ``repr``."""
    body = json.dumps(list(values), ensure_ascii=False, allow_nan=False)[:-1].encode()
    return body + b', "%08x"]\n' % crc32(body)


def from_line(line: bytes) -> list[Any]:
    """What was written. Raises Damaged, for a line without its end too."""
    body = line[: -CHECK - 1]
    if line[len(body) :] != b', "%08x"]\n' % crc32(body):
        raise Damaged("not a line of a journal")
    values: list[Any] = json.loads(body + b"]")
    return values


def plain_number(value: float) -> float | str | None:
    """A float for JSON: nan is null, an infinite one is text."""
    if math.isfinite(value):
        return float(value)
    return None if math.isnan(value) else str(float(value))


def number(plain: float | str | None) -> float:
    """The float again."""
    return math.nan if plain is None else float(plain)

"""Quantities as people write them, "45 s", "1 min 30 s", "1.2 m/s", read into SI; a bare number is refused.

>>> parse("1 min 30 s", "time")
90.0
"""

from __future__ import annotations

import math
import re
from fractions import Fraction
from functools import lru_cache
from itertools import pairwise

from opsim.problems import nearest, shown

UNITS: dict[str, dict[str, Fraction]] = {
    "time": {"ms": Fraction(1, 1000), "s": Fraction(1), "min": Fraction(60), "h": Fraction(3600), "d": Fraction(86400)},
    "length": {
        "mm": Fraction(1, 1000),
        "cm": Fraction(1, 100),
        "m": Fraction(1),
        "km": Fraction(1000),
        "in": Fraction(254, 10000),
        "ft": Fraction(3048, 10000),
    },
    "speed": {
        "m/s": Fraction(1),
        "m/min": Fraction(1, 60),
        "km/h": Fraction(1000, 3600),
        "ft/s": Fraction(3048, 10000),
    },
    "mass": {"g": Fraction(1, 1000), "kg": Fraction(1), "t": Fraction(1000), "lb": Fraction(45359237, 100_000_000)},
    "angle": {"deg": Fraction(math.pi) / 180, "rad": Fraction(1)},
}
EXAMPLES = {"time": "45 s", "length": "1.5 m", "speed": "1.2 m/s", "mass": "6 kg", "angle": "10 deg"}
_USUAL = {
    "time": ("s", "min", "h"),
    "length": ("m", "cm"),
    "speed": ("m/s", "km/h"),
    "mass": ("kg", "g"),
    "angle": ("deg", "rad"),
}
SI = {"time": "s", "length": "m", "speed": "m/s", "mass": "kg", "angle": "rad"}

# Words people use for a unit; they are not read, but the hint says how to write them.
_SPELLED = {
    **dict.fromkeys(("sec", "secs", "second", "seconds", "S"), "s"),
    **dict.fromkeys(("mins", "minute", "minutes", "Min", "MIN"), "min"),
    **dict.fromkeys(("hr", "hrs", "hour", "hours", "H"), "h"),
    **dict.fromkeys(("day", "days", "D"), "d"),
    **dict.fromkeys(("msec", "millisecond", "milliseconds"), "ms"),
    **dict.fromkeys(("metre", "metres", "meter", "meters", "M"), "m"),
    **dict.fromkeys(("centimetre", "centimetres", "centimeter", "centimeters"), "cm"),
    **dict.fromkeys(("millimetre", "millimetres", "millimeter", "millimeters"), "mm"),
    **dict.fromkeys(("foot", "feet"), "ft"),
    **dict.fromkeys(("inch", "inches"), "in"),
    **dict.fromkeys(("mps", "m/sec"), "m/s"),
    **dict.fromkeys(("kmh", "kph", "km/hr"), "km/h"),
    **dict.fromkeys(("kgs", "kilo", "kilos", "kilogram", "kilograms", "KG", "Kg"), "kg"),
    **dict.fromkeys(("gram", "grams"), "g"),
    **dict.fromkeys(("lbs", "pound", "pounds"), "lb"),
    **dict.fromkeys(("degree", "degrees", "degs", "Deg", "\u00b0"), "deg"),
    **dict.fromkeys(("radian", "radians", "Rad"), "rad"),
}
_NUMBER = r"[-+]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][-+]?[0-9]+)?"
_PIECE = re.compile(rf"\s*({_NUMBER})\s*([^\W\d_]+(?:/[^\W\d_]+)?|\u00b0)?\s*")
_CLOCK = re.compile(r"([0-9]{1,4}):([0-5][0-9]):([0-5][0-9](?:\.[0-9]+)?)")
_HALF_CLOCK = re.compile(r"([0-9]{1,4}):([0-9]{2})")
_DECIMAL_COMMA = re.compile(r"\s*[-+]?[0-9]+,[0-9]+")
_RANGE = (1e-30, 1e30)


class UnitError(ValueError):
    """Text that is not a quantity of the kind asked for: ``message`` in plain words, ``hint`` the way out."""

    def __init__(self, message: str, hint: str = ""):
        super().__init__(f"{message}; {hint}" if hint else message)
        self.message, self.hint = message, hint


def parse(value: object, kind: str) -> float:
    """The number in SI (s, m, m/s, kg, rad) of a quantity written with its unit.

    kind : "time", "length", "speed", "mass" or "angle". A time may also be written in parts ("1 min 30 s") or as a
    clock with seconds ("00:45:00"); a length in parts ("5 ft 11 in"). The result is the nearest float to the written
    number.
    Raises UnitError for a bare number, an unknown unit, a unit of another kind, or text that is no quantity.
    """
    if isinstance(value, bool) or not isinstance(value, int | float | str):
        raise UnitError(
            f"expected {a(kind)}, found {shown(value)}", f"write it with its unit, such as '{EXAMPLES[kind]}'"
        )
    if not isinstance(value, str) and not math.isfinite(value):
        raise UnitError(
            f"expected {a(kind)}, found {value}", f"write a finite number with its unit: '{EXAMPLES[kind]}'"
        )
    if not isinstance(value, str):
        raise _bare(shown(value), kind)
    return _read(value, kind)


@lru_cache(maxsize=8192)
def _read(text: str, kind: str) -> float:
    """Variants and stations say the same quantities again and again: each is read once."""
    if kind == "time" and ":" in text:
        return _clock_s(text.strip())
    return _sum(_pieces(text, kind), text, kind)


def a(kind: str) -> str:
    """A kind of quantity with its article: "a time", "an angle"."""
    return f"an {kind}" if kind == "angle" else f"a {kind}"


def written(value: float, kind: str, digits: int = 6) -> str:
    """A number in SI as people write it: angles in degrees, the rest in SI.

    >>> written(math.pi / 4, "angle")
    '45 deg'
    """
    return f"{math.degrees(value):.{digits}g} deg" if kind == "angle" else f"{value:.{digits}g} {SI[kind]}"


def pattern(kind: str) -> str:
    """A regular expression (ECMA and Python) that every quantity of a kind matches, for editors and JSON Schema."""
    known = "|".join(sorted(UNITS[kind], key=len, reverse=True))
    number = _NUMBER if kind == "length" else _NUMBER.replace("[-+]?", r"\+?", 1)  # only a place can lie below 0
    piece = rf"\s*{number}\s*(?:{known})\s*"
    pieces = f"(?:{piece})+" if kind in ("time", "length") else piece
    return rf"^(?:{pieces}|\s*{_CLOCK.pattern}\s*)$" if kind == "time" else f"^{pieces}$"


def _pieces(text: str, kind: str) -> list[tuple[str, str]]:
    """The (number, unit) pairs of a text; every unit is known and of this kind."""
    if _DECIMAL_COMMA.match(text):
        raise UnitError(
            f"cannot read {shown(text)} as {a(kind)}", f"write a decimal point: '{text.replace(',', '.')[:40]}'"
        )
    pieces, at = [], 0
    while at < len(text):
        match = _PIECE.match(text, at)
        if match is None or len(text) > 100:
            raise _unreadable(text, kind)
        pieces.append((match[1], match[2] or ""))
        at = match.end()
    if not pieces:
        raise UnitError(
            f"expected {a(kind)}, found empty text", f"write a number and its unit, such as '{EXAMPLES[kind]}'"
        )
    if any(unit not in UNITS[kind] for _, unit in pieces):
        raise _wrong_unit(pieces, text, kind)
    return pieces


def _sum(pieces: list[tuple[str, str]], text: str, kind: str) -> float:
    """The pieces added up; they must go from the larger unit to the smaller, and only the first may have a sign."""
    sizes = [UNITS[kind][unit] for _, unit in pieces]
    in_order = all(larger > smaller for larger, smaller in pairwise(sizes))
    signed = any(number[0] in "+-" for number, _ in pieces[1:]) or (len(pieces) > 1 and pieces[0][0][0] == "-")
    if not in_order or signed or (len(pieces) > 1 and kind not in ("time", "length")):
        raise UnitError(f"cannot read {shown(text)} as {a(kind)}", "write one number and one unit, or '1 min 30 s'")
    total = sum((_fraction(number, text) * size for (number, _), size in zip(pieces, sizes)), Fraction(0))
    return float(total)


def _fraction(number: str, text: str) -> Fraction:
    size = abs(float(number))
    if size != 0 and not _RANGE[0] <= size <= _RANGE[1]:
        raise UnitError(f"found {shown(text)}, expected a number from {_RANGE[0]:g} to {_RANGE[1]:g} before the unit")
    return Fraction(number) if size != 0 else Fraction(0)


def _clock_s(text: str) -> float:
    match = _CLOCK.fullmatch(text)
    if match is not None:
        return float(int(match[1]) * 3600 + int(match[2]) * 60 + Fraction(match[3]))
    half = _HALF_CLOCK.fullmatch(text)
    if half is not None:
        first, second = int(half[1]), half[2]
        raise UnitError(
            f"{shown(text)} may be hours and minutes or minutes and seconds",
            f"write '{first} h {int(second)} min' or '{first} min {int(second)} s'",
        )
    raise UnitError(f"cannot read {shown(text)} as a time", "write '45 s', '1 min 30 s' or a clock '00:45:00'")


def _unreadable(text: str, kind: str) -> UnitError:
    hint = f"write a number and its unit, such as '{EXAMPLES[kind]}'"
    return UnitError(f"cannot read {shown(text)} as {a(kind)}", hint)


def _bare(number: str, kind: str) -> UnitError:
    usual = [f"'{number} {unit}'" for unit in _USUAL[kind]]
    return UnitError(f"{number} has no unit; expected {a(kind)}", f"write {', '.join(usual[:-1])} or {usual[-1]}")


def _wrong_unit(pieces: list[tuple[str, str]], text: str, kind: str) -> UnitError:
    """What to say of the first unit that is not one of this kind."""
    unit = next(unit for _, unit in pieces if unit not in UNITS[kind])
    if not unit:
        return _bare(pieces[0][0], kind) if len(pieces) == 1 else _unreadable(text, kind)
    other = next((name for name, units in UNITS.items() if unit in units), None)
    if other is not None:
        return UnitError(f"{shown(text)} is {a(other)}; expected {a(kind)}", f"such as '{EXAMPLES[kind]}'")
    rewritten = [(number, _SPELLED.get(part, part)) for number, part in pieces]
    if all(part in UNITS[kind] for _, part in rewritten):
        plain = " ".join(f"{number} {part}" for number, part in rewritten)
        return UnitError(f"unknown unit {shown(unit)}", f"write '{plain}'")
    near = nearest(unit, UNITS[kind])
    question = f"did you mean '{near}'? " if near else ""
    return UnitError(f"unknown unit {shown(unit)}", f"{question}units of {kind}: {', '.join(UNITS[kind])}")

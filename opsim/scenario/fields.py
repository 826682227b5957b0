"""The fields a scenario is made of: quantities with units, names, whole numbers; wrong ones answered in plain words.

Changes of a layout as an engineer writes them: ``swap saw,drill``, ``place drill=spare_2``, and so on.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import Annotated, Any

from pydantic import AfterValidator, BeforeValidator, Field, WithJsonSchema, WrapValidator
from pydantic_core import PydanticCustomError

from opsim import units
from opsim.clock import LONGEST_S, STEP_S
from opsim.problems import did_you_mean, shown
from opsim.task_model import BODY_RANGES

_NAME = re.compile(r"[\w][\w \-]*")
_PER_CENT = re.compile(r"\s*([0-9]{1,3}(?:\.[0-9]{1,9})?)\s*(?:%|percent|per cent)\s*")
NAME_PATTERN = r"^[^\s!-/:-@\[-^`{-~][^!-,./:-@\[-^`{-~]*$"
"""What a name may look like, for editors: as ``is_name``, with every letter outside ASCII allowed."""


def plain_error(
    message: str, hint: str = "", *, on: str | int | None = None, or_on: str | None = None
) -> PydanticCustomError:
    """An error already in our words; ``on`` names the key inside the block that it is about.

    or_on : another key that it is about, where that one alone comes from an option or another file
    """
    return PydanticCustomError("plain", "{message}", {"message": message, "hint": hint, "on": on, "or_on": or_on})


def of_per_cent(value: object) -> str:
    """How ``5 %`` is written; empty for what is no part of a hundred."""
    match = _PER_CENT.fullmatch(value) if isinstance(value, str) else None
    return f"write {float(match[1]) / 100:g}" if match and float(match[1]) <= 100 else ""


def to_sum_to_1(total: float) -> str:
    """What to do about shares, or probabilities, whose sum is another."""
    one = f"take {total - 1:g} from" if total > 1 else f"add {1 - total:g} to"
    return f"{one} one of them, or divide each by {total:g}" if total else "give one of them 1"


def summing_to_1(what: str) -> AfterValidator:
    """Numbers by name, without those that are 0, and with a sum of 1 to the last bits; ``what`` they are called."""

    def read(numbers: dict[str, float]) -> dict[str, float]:
        total = math.fsum(numbers.values())
        if abs(total - 1) > 1e-6:
            raise plain_error(f"the {what} sum to {total:g}; they must sum to 1", to_sum_to_1(total))
        return {name: number / total for name, number in numbers.items() if number > 0}

    return AfterValidator(read)


def _quantity(
    kind: str,
    *,
    above: float | None = None,
    at_least: float | None = None,
    at_most: float | None = None,
    why: str = "",
) -> BeforeValidator:
    """Reads a quantity of a kind; bounds in SI, and why they are there."""
    example = f"'{units.EXAMPLES[kind]}'"

    def read(value: object) -> float:
        try:
            number = units.parse(value, kind)
        except units.UnitError as error:
            raise plain_error(error.message, error.hint) from None
        if above is not None and not number > above:
            least = units.written(above, kind)
            raise plain_error(f"must be more than {least}, found {shown(value)}", f"such as {example}")
        if at_least is not None and number < at_least:
            raise plain_error(
                f"must be at least {units.written(at_least, kind)}, found {shown(value)}",
                why if number >= 0 else f"such as {example}",
            )
        if at_most is not None and number > at_most:
            raise plain_error(f"must be at most {units.written(at_most, kind, 10)}, found {shown(value)}", why)
        return number

    return BeforeValidator(read)


def _as_text(kind: str) -> WithJsonSchema:
    """In the file a quantity is text; editors should know. ``quantity`` is read and taken out by ``json_schema``."""
    return WithJsonSchema(
        {"type": "string", "pattern": units.pattern(kind), "examples": [units.EXAMPLES[kind]], "quantity": kind}
    )


NEVER = "never"


def or_never(seconds: Any) -> Any:
    """A kind of time that may also be ``never``, which is longer than any."""

    def read(value: object, as_time: Callable[[object], float]) -> float:
        return math.inf if value == NEVER else as_time(value)

    text = {"type": "string", "pattern": f"{units.pattern('time')}|^{NEVER}$", "quantity": "time"}
    return Annotated[
        seconds, WrapValidator(read), WithJsonSchema({**text, "examples": [units.EXAMPLES["time"], NEVER]})
    ]


_YEARS = re.compile(r"\s*([0-9]+(?:\.[0-9]+)?)\s*years?\s*")


def _age_years(value: object) -> float:
    low, high = BODY_RANGES["age_years"]
    match = _YEARS.fullmatch(value) if isinstance(value, str) else None
    number = float(match[1]) if match is not None else value
    if isinstance(number, bool) or not isinstance(number, int | float):
        raise plain_error(f"expected an age in years, found {shown(value)}", "such as 41, or '41 years'")
    if not low <= number <= high:
        raise plain_error(f"must be from {low:g} to {high:g} years, found {shown(value)}")
    return float(number)


def _name_text(value: object) -> object:
    if isinstance(value, int | float):
        raise plain_error(f"expected a name, found {shown(value)}", f"write it in quotes: '{shown(value)}'")
    if not isinstance(value, str):
        raise plain_error(f"expected a name, found {shown(value)}")
    return value


def is_name(value: str) -> bool:
    """Whether things may be called so: the name appears in dotted paths, tables and folders."""
    return len(value) <= 100 and _NAME.fullmatch(value) is not None and value == value.strip()


def not_a_name(value: str) -> tuple[str, str]:
    """What to say of a name that cannot be one, and the way out."""
    return f"{shown(value)} cannot be a name", "use letters, digits, _ and - (at most 100)"


def _good_name(value: str) -> str:
    if not is_name(value):
        raise plain_error(*not_a_name(value))
    return value


def _whole(value: object) -> object:
    if isinstance(value, bool) or not isinstance(value, int):
        quoted = isinstance(value, str) and value.strip().isdecimal()
        raise plain_error(
            f"expected a whole number, found {shown(value)}", "remove the quotes" if quoted else _beside(value)
        )
    return value


def _beside(value: object) -> str:
    """The whole number that was meant, or those on both sides of another number."""
    if not isinstance(value, float) or not 0 <= value < 1e9:
        return ""
    if value.is_integer():
        return f"write {value:.0f}"
    return f"write {math.floor(value)} or {math.floor(value) + 1}"


def _body(kind: str, key: str) -> BeforeValidator:
    return _quantity(kind, at_least=BODY_RANGES[key][0], at_most=BODY_RANGES[key][1])


_AGE = {
    "anyOf": [
        {"type": "number", "minimum": BODY_RANGES["age_years"][0], "maximum": BODY_RANGES["age_years"][1]},
        {"type": "string", "pattern": f"^{_YEARS.pattern}$"},
    ]
}
_CLOCK = "the clock goes in steps of 2^-20 s up to 2^33 s (272 years)"
_WIDEST_M = 1e6
HIGHEST_M, DEEPEST_M = 100.0, 2.0
"""Of a level, which only a vehicle may reach; of what hands reach into."""
Seconds = Annotated[float, _quantity("time", above=0, at_least=STEP_S, at_most=LONGEST_S, why=_CLOCK), _as_text("time")]
SecondsOrZero = Annotated[float, _quantity("time", at_least=0, at_most=LONGEST_S, why=_CLOCK), _as_text("time")]
Length = Annotated[float, _quantity("length", at_least=-_WIDEST_M, at_most=_WIDEST_M), _as_text("length")]
WalkLength = Annotated[float, _quantity("length", at_least=0.1, at_most=1000), _as_text("length")]
PathLength = Annotated[float, _quantity("length", at_least=0, at_most=_WIDEST_M), _as_text("length")]
Elevation = Annotated[float, _quantity("length", at_least=0, at_most=HIGHEST_M), _as_text("length")]
Depth = Annotated[float, _quantity("length", at_least=0, at_most=DEEPEST_M), _as_text("length")]
Height = Annotated[float, _body("length", "height_m"), _as_text("length")]
Pitch = Annotated[float, _quantity("length", at_least=0.001, at_most=_WIDEST_M), _as_text("length")]
Speed = Annotated[float, _quantity("speed", above=0, at_least=0.01, at_most=100), _as_text("speed")]
BeltSpeed = Annotated[float, _quantity("speed", above=0, at_least=0.0001, at_most=100), _as_text("speed")]
Mass = Annotated[float, _body("mass", "mass_kg"), _as_text("mass")]
Age = Annotated[float, BeforeValidator(_age_years), WithJsonSchema(_AGE)]
Pace = Annotated[float, Field(ge=BODY_RANGES["pace"][0], le=BODY_RANGES["pace"][1])]
MOST_LOAD_KG = 500
"""In both hands together: nobody lifts more, and who writes more has mistaken the unit. Source: design."""
Load = Annotated[float, _quantity("mass", at_least=0, at_most=MOST_LOAD_KG), _as_text("mass")]
Angle = Annotated[float, _quantity("angle", at_least=0, at_most=math.pi), _as_text("angle")]
MostLoad = Annotated[float, _quantity("mass", above=0, at_most=10_000), _as_text("mass")]
Rating = Annotated[float, Field(ge=0.01, le=10)]
NameText = Annotated[str, BeforeValidator(_name_text)]
Name = Annotated[str, AfterValidator(_good_name)]
Whole = Annotated[int, BeforeValidator(_whole)]
EXAMPLES = {
    "move": "bench=6 m, 1 m",
    "swap": "saw,drill",
    "place": "drill=spare_2",
    "add": "second_drill=like drill at spare_1",
}
_PLACE_NAME = r"[\w][\w \-]*?"
_FORMS = {
    "move": re.compile(rf"\s*({_PLACE_NAME})\s*=\s*\[?\s*([^,\[\]]+?)\s*,\s*([^,\[\]]+?)\s*\]?\s*"),
    "swap": re.compile(rf"\s*({_PLACE_NAME})\s*,\s*({_PLACE_NAME})\s*"),
    "place": re.compile(rf"\s*({_PLACE_NAME})\s*=\s*({_PLACE_NAME})\s*"),
    "add": re.compile(rf"\s*({_PLACE_NAME})\s*=\s*like\s+({_PLACE_NAME})\s+at\s+({_PLACE_NAME})\s*"),
}


@dataclass(frozen=True, slots=True)
class Moved:
    """A change of a layout. kind : one of ``EXAMPLES``; what : the names and lengths it was said with, in that order.

    move : a place, x and y as text; swap : two stations; place : a station and a place; add : a new station, the one
    it is like, and a place
    """

    kind: str
    what: tuple[str, ...]

    def __str__(self) -> str:
        first, *rest = self.what
        said = {
            "move": f"{first}={', '.join(rest)}",
            "swap": ",".join(self.what),
            "place": "=".join(self.what),
            "add": f"{first}=like {' at '.join(rest)}",
        }
        return f"{self.kind} {said[self.kind]}"


def read_moved(kind: str, text: object) -> Moved:
    """``read_moved("swap", "saw,drill")``. Raises ValueError in our words, with an example."""
    example = f"such as {kind} {shown(EXAMPLES[kind])}"
    match = _FORMS[kind].fullmatch(text) if isinstance(text, str) else None
    if match is None:
        raise ValueError(f"{kind} {shown(text)} cannot be read; {example}")
    moved = Moved(kind, tuple(match.groups()))
    if kind == "move":
        for length in moved.what[1:]:
            _check_length(kind, text, length)
    if kind == "swap" and moved.what[0] == moved.what[1]:
        raise ValueError(f"swap {shown(text)}: a station cannot change places with itself; name two")
    return moved


def read_any_moved(text: object) -> Moved:
    """With the kind in front: ``swap saw,drill``. Raises ValueError in our words."""
    kind, _, rest = text.strip().partition(" ") if isinstance(text, str) else ("", "", "")
    if kind not in EXAMPLES:
        hint = did_you_mean(kind, EXAMPLES) if kind else "such as 'swap saw,drill'"
        raise ValueError(f"expected a change of the layout (move, swap, place or add), found {shown(text)}; {hint}")
    return read_moved(kind, rest)


def split_names(text: str) -> list[str]:
    """``a, b`` as two names."""
    return [name.strip() for name in text.split(",") if name.strip()]


def _check_length(kind: str, text: object, length: str) -> None:
    try:
        units.parse(length, "length")
    except units.UnitError as error:
        hint = f"; {error.hint}" if error.hint else ""
        raise ValueError(f"{kind} {shown(text)}: {error.message}{hint}") from None


_FRACTION = re.compile(r"\s*([0-9]{1,9})\s*/\s*([1-9][0-9]{0,8})\s*")


def _probability(value: object) -> float:
    fraction = _FRACTION.fullmatch(value) if isinstance(value, str) else None
    if fraction is not None:
        value = int(fraction[1]) / int(fraction[2])
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise plain_error(f"expected a probability, found {shown(value)}", of_per_cent(value) or "such as 0.3 or 1/3")
    if not 0 <= value <= 1:
        raise plain_error(f"a probability lies between 0 and 1, found {shown(value)}", _as_share(value))
    return float(value)


def _as_share(value: float) -> str:
    """What was probably meant: per cent, or an example."""
    return f"if it is per cent, write {value / 100:g}" if 1.5 < value <= 100 else "such as 0.3 or 1/3"


Probability = Annotated[
    float,
    BeforeValidator(_probability),
    WithJsonSchema(
        {
            "anyOf": [
                {"type": "number", "minimum": 0, "maximum": 1},
                {"type": "string", "pattern": r"^\s*[0-9]+\s*/\s*[1-9][0-9]*\s*$"},
            ],
            "description": "a probability, such as 0.3 or 1/3",
        }
    ),
]
MOST_PIECES = 10_000
"""Pieces of one part in a product, units in a lot, jobs in a batch."""


def unlimited(value: object) -> object:
    """None for 'unlimited'; other text is refused."""
    if isinstance(value, str):
        if value != "unlimited":
            raise plain_error(f"expected a whole number or unlimited, found {shown(value)}")
        return None
    return value

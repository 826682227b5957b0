"""When the load of ``opsim motion score`` is in the hands: between marks of the movement, or shares of it.

What is asked of ``opsim motion score``: what is in the hands, and how to score, with every mistake at once.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from opsim.subjects.exposure.plan import FORCES, FOREARMS, GRIPS, LEGS

EXAMPLE = "such as 'grasp..1.0', from a mark or a share of the movement to a later one"
Said = str | float


@dataclass(frozen=True)
class LoadedTime:
    """From one moment of each movement to another, each the name of a mark or a share from 0 to 1."""

    start: Said
    end: Said

    def unknown(self, mark_names: Sequence[str]) -> list[str]:
        """What speaks against it where movements have marks of these names."""
        from opsim.problems import nearest, shown

        named = [said for said in (self.start, self.end) if isinstance(said, str) and said not in mark_names]
        has = f"the movement has {', '.join(mark_names) or 'no marks, only shares such as 0.2..1.0'}"
        near = {said: nearest(said, mark_names) for said in named}
        return [
            f"--loaded: no mark {shown(said)}; {f'did you mean {shown(near[said])}?' if near[said] else has}"
            for said in named
        ]

    def moments(self, mark_names: Sequence[str]) -> tuple[Any, Any]:
        """Both as ``plan.tools.Moment``. Raises ValueError for another name."""
        from opsim.subjects.tools.plan import moment_of

        names = tuple(mark_names)
        return moment_of(self.start, names), moment_of(self.end, names)

    def in_take(self, mark_frame: Mapping[str, float], n_frames: int) -> tuple[float, float]:
        """From and to which share of a take of ``n_frames``; nan where the mark is not known in it."""
        start, end = (_share(said, mark_frame, n_frames) for said in (self.start, self.end))
        return start, end

    @property
    def words(self) -> str:
        return f"from {_in_words(self.start)} to {_in_words(self.end)}"


def loaded_of(text: str | None, wrong: list[str]) -> LoadedTime | None:
    """From ``FROM..TO``; an empty side is the beginning, or the end."""
    from opsim.problems import shown

    if text is None:
        return None
    start_text, dots, end_text = text.partition("..")
    start, end = _said(start_text, 0.0), _said(end_text, 1.0)
    numbers = [said for said in (start, end) if isinstance(said, float)]
    inside = all(0 <= said <= 1 for said in numbers)
    if not dots or not inside or start == end or (len(numbers) == 2 and numbers[0] > numbers[1]):
        wrong.append(f"--loaded: found {shown(text)}, expected FROM..TO, {EXAMPLE}")
        return None
    return LoadedTime(start, end)


def _said(text: str, otherwise: float) -> Said:
    if not text.strip():
        return otherwise
    try:
        return float(text)
    except ValueError:
        return text.strip()


def _share(said: Said, mark_frame: Mapping[str, float], n_frames: int) -> float:
    """A mark lies in the middle of its frame, as every frame is a while."""
    return said if isinstance(said, float) else (float(mark_frame[said]) + 0.5) / n_frames


def _in_words(said: Said) -> str:
    return f"{100 * said:g} %" if isinstance(said, float) else said


YES_NO = ("yes", "no")
HANDS = {"grip": GRIPS, "force": FORCES, "forearm": FOREARMS, "legs": LEGS}
FLAGS = ("arms_supported", "sitting", "rapid")
FORKS = {"arm_reference": "--arm-reference", "rula_table_a": "--rula-table", "rula_force": "--rula-force"}
ANGLES = (
    *("twist", "side", "abducted", "arm_sideways", "trunk_upright", "wrist_straight", "neck_extended"),
    *("owas_back", "owas_twist", "owas_knee"),
)
LENGTHS = ("across_m", "outside_m")


@dataclass(frozen=True)
class Asked:
    """handling, options : as a scenario would say them

    repeated         : done again and again, as no single movement tells
    loaded           : when the load is in the hands; None: all the time
    neck_neutral_rad : None: found from how the movements begin
    """

    handling: Any
    options: Any
    repeated: bool
    neck_neutral_rad: float | None
    loaded: LoadedTime | None = None


def asked_of(given: Mapping[str, Any]) -> tuple[Asked, list[str]]:
    """What the command line's words mean, and what is wrong with them, each with its option and the nearest word."""
    from opsim.ergonomics.options import USUAL
    from opsim.subjects.exposure.plan import NOT_SAID

    wrong: list[str] = []
    handling = _handling(given, wrong)
    options = _options(given, wrong)
    neutral_rad = _quantity("--neck-neutral", given["neck_neutral"], "angle", wrong)
    if neutral_rad is not None and abs(neutral_rad) > math.pi / 2:
        wrong.append(f"--neck-neutral: found {given['neck_neutral']!r}, expected -90 deg to 90 deg")
    loaded = loaded_of(given["loaded"], wrong)
    return Asked(handling or NOT_SAID, options or USUAL, given["repeated"], neutral_rad, loaded), wrong


def wrong_out(out: Path | None, source: str) -> list[str]:
    """What speaks against the page to write."""
    from opsim.cli.motion.files import overwritten

    if out is None:
        return []
    wrong = [] if out.suffix.lower() == ".html" else [f"{out}: found the ending {out.suffix!r}, expected .html"]
    return wrong + overwritten(out, movement=[source])


def _handling(given: Mapping[str, Any], wrong: list[str]) -> Any:
    from opsim.scenario.fields import MOST_LOAD_KG
    from opsim.subjects.exposure.plan import Handling

    said: dict[str, Any] = {name: _word(name, given[name], known, wrong) for name, known in HANDS.items()}
    for name in FLAGS:
        word = _word(name, given[name], YES_NO, wrong)
        said[name] = None if word is None else word == "yes"
    load_kg = _quantity("--load", given["load"], "mass", wrong)
    if load_kg is not None and not 0 <= load_kg <= MOST_LOAD_KG:
        wrong.append(f"--load: found {given['load']!r}, expected a mass of 0 kg to {MOST_LOAD_KG:g} kg in both hands")
    return Handling(load_kg=load_kg, **said)


def _options(given: Mapping[str, Any], wrong: list[str]) -> Any:
    from opsim.ergonomics.options import CHOICES, DISPUTED, USUAL, Options, Thresholds, checked

    forks = {name: _word(flag.removeprefix("--"), given[name], CHOICES[name], wrong) for name, flag in FORKS.items()}
    said = {name: word for name, word in forks.items() if word is not None}
    codes = [_word("owas-disputed", code, DISPUTED, wrong) for code in given["owas_disputed"]]
    thresholds = Thresholds(**_thresholds(given["threshold"], wrong), spread=given["spread"])
    rate_hz = USUAL.rate_hz if given["rate"] is None else given["rate"]
    options = Options(rate_hz, owas_disputed=tuple(filter(None, codes)), thresholds=thresholds, **said)
    try:
        return checked(options)
    except ValueError as error:
        wrong += [_as_option(line) for line in str(error).splitlines()]
    return None


def _as_option(line: str) -> str:
    return f"--{line.replace('rate_hz', 'rate', 1).replace('thresholds.', 'threshold ', 1)}"


def _thresholds(given: Sequence[str], wrong: list[str]) -> dict[str, float]:
    """From words such as ``twist=15 deg``, in degrees and metres."""
    from opsim.problems import did_you_mean, shown

    found: dict[str, float] = {}
    for text in given:
        name, equals, quantity = text.partition("=")
        if not equals or name.strip() not in (*ANGLES, *LENGTHS):
            words = f"--threshold: found {shown(text)}, expected e.g. 'twist=15 deg'"
            wrong.append(f"{words}; {did_you_mean(name.strip(), (*ANGLES, *LENGTHS))}")
            continue
        kind = "length" if name.strip() in LENGTHS else "angle"
        value = _quantity(f"--threshold {name.strip()}", quantity.strip(), kind, wrong)
        if value is not None:
            found[name.strip()] = value if kind == "length" else round(math.degrees(value), 9)
    return found


def _word(name: str, word: str | None, known: Sequence[str], wrong: list[str]) -> str | None:
    from opsim.problems import did_you_mean, shown

    if word is None or word in known:
        return word
    wrong.append(f"--{name.replace('_', '-')}: no {shown(word)}; {did_you_mean(word, known)}")
    return None


def _quantity(flag: str, text: str | None, kind: str, wrong: list[str]) -> float | None:
    """In SI; a bare number is refused."""
    from opsim.units import UnitError, parse

    if text is None:
        return None
    try:
        return parse(_plain_number(text), kind)
    except UnitError as error:
        wrong.append(f"{flag}: {error}")
    return None


def _plain_number(text: str) -> str | float:
    """A bare number as a number, so that it is told that a unit is missing."""
    try:
        number = float(text)
    except ValueError:
        return text
    return number if math.isfinite(number) else text

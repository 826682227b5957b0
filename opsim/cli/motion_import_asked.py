"""What is asked of ``opsim motion import``, and everything that speaks against it, said at once."""

from __future__ import annotations

import math
import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any


@dataclass(frozen=True)
class ImportAsked:
    """``options`` are those of ``emulator.recordings.importing.imported``."""

    options: dict[str, Any]
    picture: Path
    source: str | None
    licence: str | None


def asked_of(files: Sequence[str], out: Path, given: dict[str, Any]) -> ImportAsked:
    """The options as the readers take them. Raises ValueError with all that is wrong."""
    from emulator.recordings.importing import SIDES
    from emulator.recordings.orientation import AXES
    from emulator.recordings.take import wrong_pattern

    wrong = _wrong_files(files, out, given)
    unit_m, wrong_unit = _unit(given["unit"])
    rate_hz, wrong_rate = _number("--rate", given["rate"], 1.0, 10_000.0, "frames a second")
    min_score, wrong_score = _number("--min-score", given["min_score"], 0.0, 1.0, "a number")
    wrong += [*wrong_unit, *wrong_rate, *wrong_score]
    wrong += _one_of("--up", given["up"], AXES) + _one_of("--sides", given["sides"], SIDES)
    if given["names_as"] is not None and (wrong_name := wrong_pattern(given["names_as"])):
        wrong.append(wrong_name)
    if given["trial"] is not None and len(files) > 1:
        wrong.append(f"--trial {given['trial']}: found {len(files)} files, expected one; see --names")
    for name in ("worker", "trial"):
        if given[name] is not None and not (given[name].strip() and given[name].isprintable()):
            wrong.append(f"--{name}: found {given[name]!r}, expected a name")
    picture = given["picture"] or out.with_name(f"{out.stem}.import.svg")
    if picture.suffix.lower() not in (".svg", ".png"):
        wrong.append(f"--picture: found the ending {picture.suffix!r}, expected .svg or .png")
    if wrong:
        raise ValueError("\n".join(wrong))
    options = {name: given[name] for name in ("up", "columns", "sides", "worker", "trial", "names_as")}
    options |= {"unit_m": unit_m, "rate_hz": rate_hz, "min_score": min_score}
    options |= {name: None if given[name] is None else Path(given[name]) for name in ("mapping_file", "asf")}
    return ImportAsked(options, picture, given["source"], given["licence"])


def _wrong_files(files: Sequence[str], out: Path, given: dict[str, Any]) -> list[str]:
    from opsim.cli.motion_files import of_another_kind, overwritten

    if out.suffix.lower() != ".npz":
        return [f"{out}: found the ending {out.suffix!r}, but a recording ends in .npz"]
    wrong = overwritten(out, recording=files) or of_another_kind(out, "recording")
    wrong += overwritten(given["picture"], recording=files) + _twice(files)
    wrong += [
        f"{each}: found a folder, expected the name of a file to write"
        for each in (out, given["picture"])
        if each is not None and "\0" not in str(each) and each.is_dir()
    ]
    for name, option in (("mapping_file", "--map"), ("asf", "--asf")):
        if given[name] is not None and ("\0" in given[name] or not Path(given[name]).is_file()):
            wrong.append(f"{option}: {given[name]!r}: no such file")
    return wrong


def _twice(files: Sequence[str]) -> list[str]:
    """Files that are given more than once, by whatever path."""
    places: dict[str, list[int]] = {}
    for place, file in enumerate(files, 1):
        places.setdefault(file if "\0" in file else os.path.realpath(file), []).append(place)
    return [
        f"{files[at[0] - 1]}: found as file {' and '.join(map(str, at))}, expected each file once"
        for at in places.values()
        if len(at) > 1
    ]


def _unit(text: str | None) -> tuple[float | None, list[str]]:
    """Metres of one unit by its name, or as a number."""
    from emulator.recordings.orientation import UNITS_M

    if text is None or text.lower() in UNITS_M:
        return (None if text is None else UNITS_M[text.lower()]), []
    number = _float(text)
    if 1e-6 <= number <= 1e3:
        return number, []
    return None, [f"--unit: found {text!r}, expected {', '.join(UNITS_M)}, or metres of one unit such as 0.01"]


def _number(option: str, text: str | None, least: float, most: float, what: str) -> tuple[float | None, list[str]]:
    if text is None or least <= (number := _float(text)) <= most:
        return (None if text is None else number), []
    return None, [f"{option}: found {text!r}, expected {what} from {least:g} to {most:g}"]


def _float(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        return math.nan


def _one_of(option: str, text: str | None, known: Sequence[str]) -> list[str]:
    return [] if text is None or text in known else [f"{option}: found {text!r}, expected {', '.join(known)}"]

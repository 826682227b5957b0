"""What is asked of ``opsim motion fit``, and everything that speaks against it, said at once, before the first fit."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

FEWEST = 3
"""Repetitions that a model needs."""
USUAL: dict[str, Any] = {"n_components": None, "scheme": None, "n_times": 101, "landmarks": 0.0}


def asked_of(
    *, n_components: str | None, scheme: str | None, n_times: int, landmarks: str | None
) -> tuple[dict[str, Any], list[str]]:
    """The settings that differ from the usual ones, and what is wrong with them."""
    components, wrong = (None, []) if n_components is None else _components(n_components)
    strength, wrong_strength = (0.0, []) if landmarks is None else _strength(landmarks)
    wrong += _wrong_scheme(scheme) + wrong_strength
    settings = {"n_components": components, "scheme": scheme, "n_times": n_times, "landmarks": strength}
    return {name: value for name, value in settings.items() if value != USUAL[name]}, wrong


def read(
    files: Sequence[str],
    task: str | None,
    where: str | None,
    out: Path,
    asked: dict[str, Any],
    wrong: Sequence[str],
    mapping_file: Path | None = None,
) -> list[Any]:
    """The repetitions of each file. Raises ValueError with ``wrong`` and all else that speaks against a fit."""
    from emulator import read_motions

    wrong = [*_wrong_out(out, files), *wrong, *_named_wrongly(files, task)]
    chosen: dict[str, Any] = {} if where is None else {"where": None if where == "all" else where}
    sets: list[Any] = []
    names: dict[str, str] = {}
    for file in files:
        try:
            name = task if len(files) == 1 else None
            motions = read_motions(file, task=name, mapping_file=mapping_file, **chosen)
        except (ValueError, OSError) as error:
            wrong.append(str(error))
            continue
        if motions.task in names:
            both = f"both {names[motions.task]} and {file} give the task {motions.task!r}"
            wrong.append(f"{both}; rename one file, or fit it apart with --task")
        names[motions.task] = file
        wrong += _too_few(file, len(motions), asked.get("n_components"))
        sets.append(motions)
    if wrong:
        raise ValueError("\n".join(dict.fromkeys(wrong)))
    return sets


def wrong_mapping(mapping_file: str | None) -> list[str]:
    """What speaks against a file of names for joints: that it is not there."""
    if mapping_file is None or ("\0" not in mapping_file and Path(mapping_file).is_file()):
        return []
    return [f"--map: {mapping_file!r}: no such file"]


def wrong_names(files: Sequence[str], task: str | None, out: Path) -> list[str]:
    """What speaks against the file to write and the name of the task."""
    return [*_wrong_out(out, files), *_named_wrongly(files, task)]


def _components(text: str) -> tuple[int | float | None, list[str]]:
    """A number of components, or a share of the variance between 0 and 1."""
    number = _number(text)
    if 0 < number < 1:
        return number, []
    if not math.isfinite(number) or number < 1 or number != int(number):
        expected = "a whole number from 1 or a share of variance such as 0.98"
        return None, [f"--n-components: found {text!r}, expected {expected}"]
    return int(number), []


def _strength(text: str) -> tuple[float, list[str]]:
    number = _number(text)
    if 0 <= number <= 1:
        return number, []
    return 0.0, [f"--landmarks: found {text!r}, expected a number from 0 to 1"]


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        return math.nan


def _wrong_out(out: Path, files: Sequence[str]) -> list[str]:
    from opsim.cli.motion_files import of_another_kind, overwritten

    if out.suffix.lower() != ".npz":
        return [f"{out}: found the ending {out.suffix!r}, but a library ends in .npz"]
    return overwritten(out, recording=files) or of_another_kind(out, "library")


def _named_wrongly(files: Sequence[str], task: str | None) -> list[str]:
    if task is None:
        return []
    wrong = [] if len(files) == 1 else [f"--task {task}: found {len(files)} files, expected one"]
    if not task.strip() or not task.isprintable() or "/" in task:
        wrong.append(f"--task: found {task!r}, expected a name without '/'")
    return wrong


def _wrong_scheme(scheme: str | None) -> list[str]:
    from emulator.fitting.settings import unknown_scheme

    return [] if scheme is None else unknown_scheme(scheme)


def _too_few(file: str, n: int, n_components: float | None) -> list[str]:
    if n < FEWEST:
        return [f"{file}: found {n} repetition{'s' if n > 1 else ''}, expected {FEWEST} or more"]
    if n_components is not None and n_components >= n:
        return [f"{file}: --n-components: found {n_components}, expected at most {n - 1} for {n} repetitions"]
    return []

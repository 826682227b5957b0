"""``opsim motion fit``: recordings -> a motion library.

What is asked of ``opsim motion fit``, and everything that speaks against it, said at once, before the first fit.

``opsim motion fit --cyclic``: recordings of walking or other cycles -> emulators of open length.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import click

from opsim.cli.app import Mistake, mistakes


@click.command("fit")
@click.argument("files", nargs=-1, required=True, metavar="FILE.npz...")
@click.option("-o", "--out", type=click.Path(path_type=Path), required=True, help="The library to write, a .npz file.")
@click.option("--task", help="The name of the task, for one FILE.  [default: the file's name]")
@click.option("--family", metavar="NAME", help="One task NAME from all FILEs: one movement at different places.")
@click.option(
    "--where", help="Which repetitions, such as 'cov_correct==1'; 'all' takes all.  [default: the correct ones]"
)
@click.option(
    "--n-components",
    metavar="NUMBER",
    help="Posture components, or their share of variance.  [default: as many as held-out repetitions need]",
)
@click.option(
    "--scheme",
    metavar="NAME",
    help="Representation/reduction/density, or auto: by cross-validation.  [default: Extrinsic/JointPCA/Smoothed]",
)
@click.option(
    "--n-times", type=click.IntRange(10, 2001), default=101, help="Points of the common clock.  [default: 101]"
)
@click.option(
    "--landmarks",
    metavar="NUMBER",
    help="How strongly marks are drawn together, 0 to 1; 0.01 is strong.  [default: 0]",
)
@click.option(
    "--covariate",
    "covariates",
    multiple=True,
    metavar="NAME",
    help="A column of the recordings that explains how people differ, beside height, mass, age, sex, pace; repeatable.",
)
@click.option("--map", "mapping_file", metavar="FILE", help="Lines 'name in the file: joint' for names not known here.")
@click.option("--cyclic", is_flag=True, help="Takes of several cycles (walking, cranking): emulators of any length.")
@click.option("--seed", type=click.IntRange(min=0), default=0, help="For the figures of the report only.")
@click.option("--json", "as_json", is_flag=True, help="JSON for machines.")
def command(
    files: tuple[str, ...],
    out: Path,
    task: str | None,
    family: str | None,
    where: str | None,
    n_components: str | None,
    scheme: str | None,
    n_times: int,
    landmarks: str | None,
    covariates: tuple[str, ...],
    mapping_file: str | None,
    cyclic: bool,
    seed: int,
    as_json: bool,
) -> None:
    """Train an emulator on each recording FILE, a task each (or all one --family), and write them into one library."""
    from opsim.cli.app import held
    from opsim.cli.motion.family import wrong_family
    from opsim.cli.motion.files import no_empty_folders, ready

    with mistakes():
        asked, wrong = asked_of(n_components=n_components, scheme=scheme, n_times=n_times, landmarks=landmarks)
        asked |= {"covariates": covariates} if covariates else {}
        wrong += wrong_mapping(mapping_file)
        names = None if mapping_file is None or wrong else Path(mapping_file)
        wrong += wrong_family(family, files, task, cyclic)
        if cyclic:
            sets: list[Any] = list(_cyclic(files, task, where, out, asked, wrong, names))
        else:
            sets = read(files, task, where, out, asked, wrong, names, family)
    said = _said(files, out, task, where, asked) + " --cyclic" * cyclic
    said += "" if family is None else f" --family '{family}'"
    said += "" if mapping_file is None else f" --map {Path(mapping_file).name}"
    with no_empty_folders(out.parent):
        with mistakes():
            ready(out, ".npz")
        library, failed = _fitted(sets, asked, seed, said, out)
    if as_json and library:
        _print_json(out, library, family)
    elif library:
        _print(out, library, family)
    if failed:
        raise Mistake("\n".join([*failed, *([held(out, library, [m.task for m in sets])] if library else [])]))


def _fitted(sets: Sequence[Any], asked: dict[str, Any], seed: int, said: str, out: Path) -> tuple[Any, list[str]]:
    """The library, written as far as it came, and what failed; a task that fails takes nothing from the others."""
    from emulator import MotionLibrary
    from opsim.cli.app import held, stopped, stops_once

    library, failed = MotionLibrary.of(command=said), []
    with stops_once():
        try:
            for motions in sets:
                try:
                    with mistakes():
                        library = library.add(_model(motions, asked, seed, said))
                except Mistake as mistake:
                    failed.append(f"{motions.task}: {mistake.message.removeprefix(f'{motions.task}: ')}")
        except BaseException as error:  # also a bug of ours, which goes on with its traceback
            _save(library, out)
            if isinstance(error, KeyboardInterrupt):
                raise stopped(error, held(out, library, [motions.task for motions in sets])) from None
            raise
        _save(library, out)
    return library, failed


@dataclass(frozen=True)
class CyclicTakes:
    """The takes of one file, to be fitted as motion that goes on and on."""

    task: str
    recording: Any
    where: str


def _cyclic(
    files: Sequence[str],
    task: str | None,
    where: str | None,
    out: Path,
    asked: dict[str, Any],
    wrong: Sequence[str],
    mapping_file: Path | None,
) -> list[CyclicTakes]:

    other = wrong_with_cyclic(
        **{name: name in asked for name in ("scheme", "n_times", "landmarks")}, covariate="covariates" in asked
    )
    found = read_cyclic(files, task, where, [*wrong_names(files, task, out), *wrong, *other], mapping_file)
    return [CyclicTakes(name, recording, where or "all") for name, recording in found]


def _model(motions: Any, asked: dict[str, Any], seed: int, said: str) -> Any:
    from emulator import MotionEmulator
    from opsim.cli.progress import progress

    if isinstance(motions, CyclicTakes):
        components = asked.get("n_components")
        return cyclic_model(motions.task, motions.recording, components, seed, motions.where, said)

    with progress(f"fit {motions.task}") as report:
        return MotionEmulator.fit(motions, progress=report, seed=seed, command=said, **asked)


def _save(library: Any, out: Path) -> None:
    with mistakes():
        if library:
            library.save(out)


def _said(files: Sequence[str], out: Path, task: str | None, where: str | None, asked: dict[str, Any]) -> str:
    """The command as provenance: names of files without the folders of this machine."""
    words = ["opsim motion fit", *(Path(file).name for file in files), "-o", out.name]
    words += [] if task is None else ["--task", f"'{task}'"]
    words += [] if where is None else ["--where", f"'{where}'"]
    words += [word for name in asked.get("covariates", ()) for word in ("--covariate", name)]
    for name, value in asked.items():
        if name == "covariates":
            continue
        words += [f"--{name.replace('_', '-')}", value if isinstance(value, str) else f"{value:g}"]
    return " ".join(words)


def _print_json(out: Path, library: Any, family: str | None) -> None:
    from opsim.cli.app import print_json
    from opsim.cli.motion.family import heights_plain

    tasks = {name: model.report.as_dict() for name, model in library.items()}
    if family is not None:
        tasks[family]["heights"] = heights_plain(library[family])
    print_json({"library": str(out), "tasks": tasks})


def _print(out: Path, library: Any, family: str | None) -> None:
    from opsim.cli.motion.family import print_heights

    for model in library.values():
        _print_report(model.report)
        if family is not None:
            print_heights(model)
    tasks = f"{len(library)} task{'s' if len(library) > 1 else ''}"
    click.echo(f"library: {out} ({out.stat().st_size / 1e6:.2f} MB, {tasks})")


def _print_report(report: Any) -> None:
    from opsim.cli.app import print_table

    rows = [*report.rows(), ("source", report.source), ("licence", report.licence)]
    rows += [("note", note) for note in report.notes]
    print_table(report.task, ("", "found"), rows, words=2)


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
    family: str | None = None,
) -> list[Any]:
    """The repetitions of each file, or of all as a family. Raises ValueError with ``wrong`` and all else amiss."""
    from emulator import read_motions
    from opsim.cli.motion.family import pooled, wrong_covariates

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
        sets.append(motions)
    if family is not None and len(sets) == len(files) > 1:
        wrong, sets = pooled(family, files, sets, wrong)
    for motions in sets:
        where_from = names.get(motions.task, f"--family {family}")
        wrong += _too_few(where_from, len(motions), asked.get("n_components"))
        wrong += wrong_covariates(where_from, motions, asked.get("covariates", ()))
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
    from opsim.cli.motion.files import of_another_kind, overwritten

    if out.suffix.lower() != ".npz":
        return [f"{out}: found the ending {out.suffix!r}, but a library ends in .npz"]
    return overwritten(out, recording=files) or of_another_kind(out, "library")


def _named_wrongly(files: Sequence[str], task: str | None) -> list[str]:
    if task is None:
        return []
    wrong = [] if len(files) == 1 else [f"--task {task}: found {len(files)} files, expected one"]
    from opsim.cli.motion.family import no_name

    if no_name(task):
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


def read_cyclic(
    files: Sequence[str], task: str | None, where: str | None, wrong: Sequence[str], mapping_file: Path | None = None
) -> list[tuple[str, Any]]:
    """(task, recording) of each file, of the takes that ``where`` chooses. Raises ValueError with all mistakes."""
    from emulator.recordings.npz import read_recording

    wrong, found = [*wrong], []
    for file in files:
        name = task if task is not None and len(files) == 1 else Path(file).stem
        try:
            found.append((name, _chosen(read_recording(file, mapping_file=mapping_file), where)))
        except (ValueError, OSError) as error:
            wrong.append(f"{file}: {str(error).removeprefix(f'{file}: ')}")
    names = [name for name, _ in found]
    wrong += [f"two files give the task {name!r}; rename one" for name in sorted(set(names)) if names.count(name) > 1]
    if wrong:
        raise ValueError("\n".join(dict.fromkeys(wrong)))
    return found


def wrong_with_cyclic(**options: Any) -> list[str]:
    """Settings of the other kind of emulator that were given, in words."""
    return [
        f"--{name.replace('_', '-')}: found together with --cyclic, expected without: it belongs to repetitions"
        for name, value in options.items()
        if value
    ]


def cyclic_model(task: str, recording: Any, components: int | float | None, seed: int, where: str, said: str) -> Any:
    """The emulator of one recording, with progress. Raises ValueError in plain words."""
    from emulator.cyclic.model import CyclicEmulator
    from opsim.cli.progress import progress

    asked = {} if components is None else {"components": components}
    with progress(f"fit {task}") as report:
        return CyclicEmulator.fit(recording, task=task, seed=seed, where=where, command=said, progress=report, **asked)


def _chosen(recording: Any, where: str | None) -> Any:
    """The takes that fulfil the expression; None or "all": every one."""
    from emulator.recordings.selection import rows_where

    if where in (None, "all"):
        return recording
    takes = recording.takes
    shared = set.intersection(*(set(take.covariates) for take in takes))
    columns: dict[str, list[Any]] = {key: [take.covariates[key] for take in takes] for key in sorted(shared)}
    columns |= {
        "worker": [take.worker for take in takes],
        "trial": [take.trial for take in takes],
        "duration_s": [take.duration_s for take in takes],
    }
    kept = tuple(take for take, keep in zip(takes, rows_where(str(where), columns)) if keep)
    if not kept:
        raise ValueError(f"no take fulfils {where!r}")
    return replace(recording, takes=kept)

"""``opsim motion fit``: recordings -> a motion library."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import click

from opsim.cli.verbs import mistakes

FEWEST = 3
"""Repetitions that a model needs."""


class _Components(click.ParamType):
    """A number of components, or a share of the variance between 0 and 1."""

    name = "number"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> int | float:
        try:
            number = float(value)
        except ValueError:
            number = math.nan
        if 0 < number < 1:
            return number
        if not math.isfinite(number) or number < 1 or number != int(number):
            expected = "a whole number from 1 or a share of variance such as 0.98"
            self.fail(f"expected {expected}, found {value!r}", param, ctx)
        return int(number)


@click.command("fit")
@click.argument("files", nargs=-1, required=True, metavar="FILE.npz...")
@click.option("-o", "--out", type=click.Path(path_type=Path), required=True, help="The library to write, a .npz file.")
@click.option("--task", help="The name of the task, for one FILE.  [default: the file's name]")
@click.option(
    "--where", help="Which repetitions, such as 'cov_correct==1'; 'all' takes all.  [default: the correct ones]"
)
@click.option(
    "--n-components",
    type=_Components(),
    help="Posture components, or their share of variance.  [default: as many as held-out repetitions need]",
)
@click.option(
    "--scheme",
    default="",
    metavar="NAME",
    help="Representation/reduction/density, or auto: chosen by cross-validation.  [default: SIEM/JointPCA/Smoothed]",
)
@click.option(
    "--n-times", type=click.IntRange(10, 2001), default=101, help="Points of the common clock.  [default: 101]"
)
@click.option(
    "--landmarks",
    type=click.FloatRange(0, 1),
    default=0.0,
    help="How strongly marks are drawn together; 0.01 is strong.",
)
@click.option("--seed", type=click.IntRange(min=0), default=0, help="For the figures of the report only.")
@click.option("--json", "as_json", is_flag=True, help="JSON for machines.")
def command(
    files: tuple[str, ...],
    out: Path,
    task: str | None,
    where: str | None,
    n_components: float | None,
    scheme: str,
    n_times: int,
    landmarks: float,
    seed: int,
    as_json: bool,
) -> None:
    """Train an emulator on each recording FILE, a task each, and write them into one library."""
    from opsim.cli.console import print_json
    from opsim.cli.motion_files import ready

    with mistakes():
        if out.suffix.lower() != ".npz":
            raise ValueError(f"{out}: a library ends in .npz")
        asked = _asked(n_components=n_components, scheme=scheme, n_times=n_times, landmarks=landmarks)
        sets = _read(files, task, where, asked)
        ready(out, ".npz")
        library = _fitted(sets, asked, seed, _said(files, out, task, where, asked))
        library.save(out)
    if as_json:
        print_json({"library": str(out), "tasks": {name: model.report.as_dict() for name, model in library.items()}})
        return
    for model in library.values():
        _print_report(model.report)
    click.echo(
        f"library: {out} ({out.stat().st_size / 1e6:.2f} MB, {len(library)} task{'s' if len(library) > 1 else ''})"
    )


def _read(files: Sequence[str], task: str | None, where: str | None, asked: dict[str, Any]) -> list[Any]:
    """The repetitions of each file. Raises ValueError with all that speaks against a fit, before the first one."""
    from emulator import read_motions

    wrong = _named_wrongly(files, task) + _wrong_scheme(asked.get("scheme"))
    chosen = {} if where is None else {"where": None if where == "all" else where}
    sets: list[Any] = []
    names: dict[str, str] = {}
    for file in files:
        try:
            motions = read_motions(file, task=task if len(files) == 1 else None, **chosen)
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


def _named_wrongly(files: Sequence[str], task: str | None) -> list[str]:
    if task is None:
        return []
    wrong = [] if len(files) == 1 else [f"--task {task}: found {len(files)} files, expected one"]
    if not task.strip() or not task.isprintable() or "/" in task:
        wrong.append(f"--task: found {task!r}, expected a name without '/'")
    return wrong


def _wrong_scheme(scheme: str | None) -> list[str]:
    from emulator.fit_settings import unknown_scheme

    return [] if scheme is None else unknown_scheme(scheme)


def _too_few(file: str, n: int, n_components: float | None) -> list[str]:
    if n < FEWEST:
        return [f"{file}: found {n} repetition{'s' if n > 1 else ''}, expected {FEWEST} or more"]
    if n_components is not None and n_components >= n:
        return [f"{file}: --n-components: found {n_components}, expected at most {n - 1} for {n} repetitions"]
    return []


def _asked(**settings: Any) -> dict[str, Any]:
    """The settings that differ from the default."""
    usual = {"n_components": None, "scheme": "", "n_times": 101, "landmarks": 0.0}
    return {name: value for name, value in settings.items() if value != usual[name]}


def _fitted(sets: Sequence[Any], asked: dict[str, Any], seed: int, said: str) -> Any:
    from emulator import MotionEmulator, MotionLibrary
    from opsim.cli.progress import progress

    library = MotionLibrary.of(command=said)
    for motions in sets:
        with progress(f"fit {motions.task}") as report:
            model = MotionEmulator.fit(motions, progress=report, seed=seed, command=said, **asked)
        library = library.add(model)
    return library


def _said(files: Sequence[str], out: Path, task: str | None, where: str | None, asked: dict[str, Any]) -> str:
    """The command as provenance: names of files without the folders of this machine."""
    words = ["opsim motion fit", *(Path(file).name for file in files), "-o", out.name]
    words += [] if task is None else ["--task", f"'{task}'"]
    words += [] if where is None else ["--where", f"'{where}'"]
    for name, value in asked.items():
        words += [f"--{name.replace('_', '-')}", value if isinstance(value, str) else f"{value:g}"]
    return " ".join(words)


def _print_report(report: Any) -> None:
    from opsim.cli.console import print_table

    rows = [*report.rows(), ("source", report.source), ("licence", report.licence)]
    rows += [("note", note) for note in report.notes]
    print_table(report.task, ("", "found"), rows, words=2)

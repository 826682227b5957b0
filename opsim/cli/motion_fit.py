"""``opsim motion fit``: recordings -> a motion library."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import click

from opsim.cli.verbs import Mistake, mistakes


@click.command("fit")
@click.argument("files", nargs=-1, required=True, metavar="FILE.npz...")
@click.option("-o", "--out", type=click.Path(path_type=Path), required=True, help="The library to write, a .npz file.")
@click.option("--task", help="The name of the task, for one FILE.  [default: the file's name]")
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
@click.option("--map", "mapping_file", metavar="FILE", help="Lines 'name in the file: joint' for names not known here.")
@click.option("--cyclic", is_flag=True, help="Takes of several cycles (walking, cranking): emulators of any length.")
@click.option("--seed", type=click.IntRange(min=0), default=0, help="For the figures of the report only.")
@click.option("--json", "as_json", is_flag=True, help="JSON for machines.")
def command(
    files: tuple[str, ...],
    out: Path,
    task: str | None,
    where: str | None,
    n_components: str | None,
    scheme: str | None,
    n_times: int,
    landmarks: str | None,
    mapping_file: str | None,
    cyclic: bool,
    seed: int,
    as_json: bool,
) -> None:
    """Train an emulator on each recording FILE, a task each, and write them into one library."""
    from opsim.cli.motion_files import no_empty_folders, ready
    from opsim.cli.motion_fit_asked import asked_of, read, wrong_mapping
    from opsim.cli.stopping import held

    with mistakes():
        asked, wrong = asked_of(n_components=n_components, scheme=scheme, n_times=n_times, landmarks=landmarks)
        wrong += wrong_mapping(mapping_file)
        names = None if mapping_file is None or wrong else Path(mapping_file)
        sets = (_cyclic if cyclic else read)(files, task, where, out, asked, wrong, names)
    said = _said(files, out, task, where, asked) + " --cyclic" * cyclic
    said += "" if mapping_file is None else f" --map {Path(mapping_file).name}"
    with no_empty_folders(out.parent):
        with mistakes():
            ready(out, ".npz")
        library, failed = _fitted(sets, asked, seed, said, out)
    if as_json and library:
        _print_json(out, library)
    elif library:
        _print(out, library)
    if failed:
        raise Mistake("\n".join([*failed, *([held(out, library, [m.task for m in sets])] if library else [])]))


def _fitted(sets: Sequence[Any], asked: dict[str, Any], seed: int, said: str, out: Path) -> tuple[Any, list[str]]:
    """The library, written as far as it came, and what failed; a task that fails takes nothing from the others."""
    from emulator import MotionLibrary
    from opsim.cli.stopping import held, stopped, stops_once

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
    from opsim.cli.motion_fit_asked import wrong_names
    from opsim.cli.motion_fit_cyclic import read_cyclic, wrong_with_cyclic

    other = wrong_with_cyclic(**{name: name in asked for name in ("scheme", "n_times", "landmarks")})
    found = read_cyclic(files, task, where, [*wrong_names(files, task, out), *wrong, *other], mapping_file)
    return [CyclicTakes(name, recording, where or "all") for name, recording in found]


def _model(motions: Any, asked: dict[str, Any], seed: int, said: str) -> Any:
    from emulator import MotionEmulator
    from opsim.cli.motion_fit_cyclic import cyclic_model
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
    for name, value in asked.items():
        words += [f"--{name.replace('_', '-')}", value if isinstance(value, str) else f"{value:g}"]
    return " ".join(words)


def _print_json(out: Path, library: Any) -> None:
    from opsim.cli.console import print_json

    print_json({"library": str(out), "tasks": {name: model.report.as_dict() for name, model in library.items()}})


def _print(out: Path, library: Any) -> None:
    for model in library.values():
        _print_report(model.report)
    tasks = f"{len(library)} task{'s' if len(library) > 1 else ''}"
    click.echo(f"library: {out} ({out.stat().st_size / 1e6:.2f} MB, {tasks})")


def _print_report(report: Any) -> None:
    from opsim.cli.console import print_table

    rows = [*report.rows(), ("source", report.source), ("licence", report.licence)]
    rows += [("note", note) for note in report.notes]
    print_table(report.task, ("", "found"), rows, words=2)

"""``opsim motion fit``: recordings -> a motion library."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from opsim.cli.verbs import mistakes


class _Components(click.ParamType):
    """A number of components, or a share of the variance between 0 and 1."""

    name = "number"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> int | float:
        try:
            number = float(value)
        except ValueError:
            self.fail(f"expected a whole number or a share of variance such as 0.95, found {value!r}", param, ctx)
        if 0 < number < 1:
            return number
        if number < 1 or number != int(number):
            self.fail(
                f"expected a whole number from 1 or a share of variance such as 0.95, found {value!r}", param, ctx
            )
        return int(number)


@click.command("fit")
@click.argument("files", nargs=-1, required=True, metavar="FILE.npz...")
@click.option("-o", "--out", type=click.Path(path_type=Path), required=True, help="The library to write, a .npz file.")
@click.option(
    "--where", help="Which repetitions, such as 'cov_correct==1'; 'all' takes all.  [default: the correct ones]"
)
@click.option(
    "--n-components", type=_Components(), help="Posture components, or their share of variance.  [default: 0.95]"
)
@click.option("--seed", type=click.IntRange(min=0), default=0, help="For the figures of the report only.")
@click.option("--json", "as_json", is_flag=True, help="JSON for machines.")
def command(
    files: tuple[str, ...], out: Path, where: str | None, n_components: float | None, seed: int, as_json: bool
) -> None:
    """Train an emulator on each recording FILE, a task each, and write them into one library."""
    from opsim.cli.console import print_json

    with mistakes():
        if out.suffix.lower() != ".npz":
            raise ValueError(f"{out}: a library ends in .npz")
        said = _said(files, out, where, n_components)
        library = _fitted(files, where, n_components, seed, said)
        out.parent.mkdir(parents=True, exist_ok=True)
        library.save(out)
    if as_json:
        print_json({"library": str(out), "tasks": {task: model.report.as_dict() for task, model in library.items()}})
        return
    for model in library.values():
        _print_report(model.report)
    click.echo(
        f"library: {out} ({out.stat().st_size / 1e6:.2f} MB, {len(library)} task{'s' if len(library) > 1 else ''})"
    )


def _fitted(files: tuple[str, ...], where: str | None, n_components: float | None, seed: int, said: str) -> Any:
    from emulator import MotionEmulator, MotionLibrary, read_motions
    from opsim.cli.progress import progress

    chosen = {} if where is None else {"where": None if where == "all" else where}
    sets = [read_motions(file, **chosen) for file in files]
    library = MotionLibrary.of(command=said)
    for motions in sets:
        with progress(f"fit {motions.task}") as report:
            model = MotionEmulator.fit(motions, n_components=n_components, progress=report, seed=seed, command=said)
        library = library.add(model)
    return library


def _said(files: tuple[str, ...], out: Path, where: str | None, n_components: float | None) -> str:
    """The command as provenance: names of files without the folders of this machine."""
    words = ["opsim motion fit", *(Path(file).name for file in files), "-o", out.name]
    words += [] if where is None else ["--where", f"'{where}'"]
    return " ".join(words + ([] if n_components is None else ["--n-components", f"{n_components:g}"]))


def _print_report(report: Any) -> None:
    from opsim.cli.console import print_table

    rows = [*report.rows(), ("source", report.source), ("licence", report.licence)]
    rows += [("note", note) for note in report.notes]
    print_table(report.task, ("", "found"), rows, words=2)

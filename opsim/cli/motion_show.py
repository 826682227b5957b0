"""``opsim motion show``: a task of a library as strips of stick figures."""

from __future__ import annotations

from pathlib import Path

import click

from opsim.cli.verbs import mistakes


@click.command("show")
@click.argument("library")
@click.argument("task", required=False)
@click.option("-o", "--out", type=click.Path(path_type=Path), help="A .png or .svg file.  [default: <task>.png]")
@click.option("-n", "n", type=click.IntRange(min=1, max=20), default=3, show_default=True, help="Drawn performances.")
@click.option("--seed", type=click.IntRange(min=0), default=0, show_default=True)
@click.option("--json", "as_json", is_flag=True, help="JSON for machines.")
def command(library: str, task: str | None, out: Path | None, n: int, seed: int, as_json: bool) -> None:
    """Draw a TASK of a LIBRARY along real time: the mean performance above drawn ones."""
    from opsim.cli.console import print_json
    from opsim.cli.motion_files import chosen, ready
    from opsim.provenance import behind
    from opsim.report import draw_strips

    with mistakes():
        model = chosen(library, task)
        out = out if out is not None else Path(f"{Path(model.task).name}.png")
        ready(out, ".png", ".svg")
        report = model.report
        title = f"{model.task}: emulated from {behind(report.source, report.n_sequences, report.n_workers)}"
        draw_strips(model, out, n_samples=n, seed=seed, title=title)
    if as_json:
        print_json({"task": model.task, "out": str(out), "samples": n, "seed": seed, "source": report.source})
        return
    click.echo(f"{title}\nsource: {report.source}\npicture: {out}")

"""``opsim fit``: recorded times -> the line of a scenario that says them, with how well it fits."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from opsim.cli.app import mistakes

POOR = 0.05
ALIKE = 0.3


@click.command("fit")
@click.argument("file", type=click.Path(path_type=Path))
@click.option("--column", help="Column of the times, in seconds; needed where there are several.")
@click.option("--worker", help="Column of who took each time: tells how far workers differ.")
@click.option("--json", "as_json", is_flag=True, help="JSON for machines.")
def command(file: Path, column: str | None, worker: str | None, as_json: bool) -> None:
    """Fit distributions to the times in a CSV FILE: the best first, with its goodness of fit and its line of YAML."""
    from opsim.cli.app import print_json, print_table

    if worker is not None and worker == column:
        raise click.UsageError(
            f"--column and --worker are both {column!r}; the times and their workers are two columns"
        )
    with mistakes():
        found = _found(file, column, worker)
    if as_json:
        print_json(found)
        return
    columns = ("distribution", "mean", "cv", "AIC above best", "KS distance", "p")
    rows = [_cells(one, found["families"][0]["aic"]) for one in found["families"]]
    print_table(f"{file.name}: {found['n']} times, mean {found['mean_s']:.4g} s, cv {found['cv']:.3g}", columns, rows)
    for line in found["remarks"]:
        click.echo(line)
    click.echo(f"in a scenario: {{{found['said']}}}")


def _found(file: Path, column: str | None, worker: str | None) -> dict[str, Any]:
    import numpy as np

    from opsim.csv_input import read_labels, read_times
    from opsim.fitting import between_share, fitted

    column = column or _other_column(file, worker)
    times_s = np.array(read_times(file, column, "--column"))
    share = None if worker is None else between_share(times_s, read_labels(file, worker))
    families = fitted(times_s)
    best, named = families[0], f"recorded: {file.name}" + (f", column: {column}" if column else "")
    said = best.said if best.p >= POOR else f"{named}, by: smooth"
    if share and best.p >= POOR and hasattr(best.model, "between_share"):
        said += f", between_share: {share:.2g}"
    after = float(np.corrcoef(times_s[:-1], times_s[1:])[0, 1])
    return {
        "file": str(file),
        "n": times_s.size,
        "mean_s": float(times_s.mean()),
        "cv": float(times_s.std() / times_s.mean()),
        "between_share": share,
        "families": [{"dist": one.dist, **{key: getattr(one, key) for key in _SHOWN}} for one in families],
        "remarks": _remarks(named, best.p, share, after, times_s.size),
        "said": said,
    }


def _other_column(file: Path, worker: str | None) -> str | None:
    """The only column beside that of the workers; None where there is no such."""
    from opsim.csv_input import column_names

    others = [] if worker is None else [name for name in column_names(file) if name != worker]
    return others[0] if len(others) == 1 else None


_SHOWN = ("mean_s", "cv", "aic", "distance", "p", "said")


def _remarks(named: str, p: float, share: float | None, after: float, n: int) -> list[str]:
    said = []
    if share is not None:
        said.append(f"{share:.0%} of the variance of log time lies between workers")
    if p < POOR:
        said.append(f"no family fits well (p {p:.3f}): better take the times themselves, smoothed")
    if after > max(ALIKE, 2 / n**0.5):
        said.append(f"times that follow each other are alike (r {after:.2f}): {{{named}, by: trace}} keeps their order")
    return said


def _cells(one: dict[str, Any], best: float) -> tuple[str, ...]:
    p = f"{one['p']:.3f}" if one["p"] >= POOR else f"{one['p']:.3f} poor"
    return (
        one["dist"],
        f"{one['mean_s']:.4g} s",
        f"{one['cv']:.3g}",
        f"{one['aic'] - best:.1f}",
        f"{one['distance']:.3f}",
        p,
    )

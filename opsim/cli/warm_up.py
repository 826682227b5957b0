"""``opsim warm-up``: how long a run needs to forget that it began empty."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from opsim.cli.app import mistakes


@click.command("warm-up")
@click.argument("folder", metavar="RESULTS", type=click.Path(path_type=Path))
@click.option("--picture", type=click.Path(path_type=Path), help="Draw the series into this .png or .svg file.")
@click.option("--json", "as_json", is_flag=True, help="JSON for machines.")
def command(folder: Path, picture: Path | None, as_json: bool) -> None:
    """Suggest a warm-up from the RESULTS of a run or of one of its variants, by MSER-5 on the average replication."""
    from opsim.cli.app import print_json
    from opsim.results import variants_in
    from opsim.study.long_run.warm_up import suggested_warm_up

    with mistakes():
        if picture is not None and picture.suffix.lower() not in (".png", ".svg"):
            raise ValueError(f"{picture}: expected a .png or a .svg file")
        results = variants_in(folder)
        found = {name: suggested_warm_up(result) for name, result in results.items()}
        pictures = {} if picture is None else _draw(found, results, picture)
    if as_json:
        print_json({"variants": [_as_json(name, results[name], found[name], pictures.get(name)) for name in found]})
        return
    _print(found, results)
    for drawn in pictures.values():
        click.echo(f"picture: {drawn}")


def _draw(found: dict[str, Any], results: dict[str, Any], picture: Path) -> dict[str, Path]:
    from opsim.report.studies.steady_state import draw_warm_up

    named = {name: picture.with_stem(f"{picture.stem}_{name}") if len(found) > 1 else picture for name in found}
    return {
        name: draw_warm_up(
            of, named[name], f"{results[name].summary['scenario']}, {name}, {_replications(results[name])}"
        )
        for name, of in found.items()
    }


def _replications(result: Any) -> str:
    n = len(result.events_files)
    return "1 replication" if n == 1 else f"average of {n} replications"


def _print(found: dict[str, Any], results: dict[str, Any]) -> None:
    from opsim.cli.app import print_table
    from opsim.cli.run import without_repeats
    from opsim.report.numbers import kpi_name, quantity

    rows: list[tuple[str, ...]] = []
    for name, series in found.items():
        own_s = results[name].summary["window_s"][0]
        rows += [
            (name, kpi_name(of.name), _until(of), quantity(own_s, "s", 60.0), _verdict(of, own_s)) for of in series
        ]
    columns = ("variant", "series", "suggested", "the run's own", "")
    print_table("Warm-up by MSER-5", columns, without_repeats(rows), words=2)
    click.echo(_advice(any(of.until_s is not None for series in found.values() for of in series)))


def _advice(is_found: bool) -> str:
    if is_found:
        return "Take the longest, rounded up, and look at the picture (--picture) before you believe it."
    return "No warm-up is found in any series: run longer, and look at the picture (--picture) of what there is."


def _until(of: Any) -> str:
    from opsim.report.numbers import quantity

    return "not found" if of.until_s is None else quantity(of.until_s, "s", 5 * of.slice_s)


def _verdict(of: Any, own_s: float) -> str:
    if of.until_s is None:
        return "the run is too short to tell: make its horizon longer"
    return "long enough" if own_s >= of.until_s else "too short"


def _as_json(name: str, result: Any, series: list[Any], picture: Path | None) -> dict[str, Any]:
    return {
        "variant": name,
        "replications": len(result.events_files),
        "own_warm_up_s": result.summary["window_s"][0],
        "series": [{"kpi": of.name, "slice_s": of.slice_s, "warm_up_s": of.until_s} for of in series],
        "picture": None if picture is None else str(picture),
    }

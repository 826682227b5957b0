"""``opsim compare``: variants against a base, replication by replication."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from opsim.cli.engine_option import engine_option
from opsim.cli.verbs import mistakes


@click.command("compare")
@click.argument("of", metavar="FOLDER|FILE")
@click.option("--base", metavar="NAME", help="The variant to compare with.  [default: base, or else the first]")
@click.option("--kpi", "kpis", multiple=True, metavar="NAME", help="This figure; may be given again.")
@click.option("--frontier", metavar="FIGURE,FIGURE", help="Two figures, one against the other, over all variants.")
@click.option("-o", "--out", type=click.Path(path_type=Path), help="Results folder, where a FILE is run first.")
@click.option("--replications", type=click.IntRange(min=1), help="Of a FILE, instead of its own.")
@click.option("--seed", type=click.IntRange(min=0), help="Of a FILE, instead of its own.")
@engine_option(None)
@click.option("--processes", type=click.IntRange(min=1), help="Processes to use for a FILE.  [default: as many as pay]")
@click.option("--json", "as_json", is_flag=True, help="JSON for machines.")
def command(
    of: str, base: str | None, kpis: tuple[str, ...], frontier: str | None, out: Path | None, as_json: bool, **how: Any
) -> None:
    """Compare the variants in a results FOLDER, or those of a scenario FILE, which are run first.

    Replications with the same number have the same random numbers in every variant, so their differences say more.
    """
    from opsim.cli.compare_frontier import frontier_json, frontier_or_why, print_frontier
    from opsim.cli.console import print_json
    from opsim.cli.running import Failed
    from opsim.study.compare import compare

    with mistakes():
        folder, results = _results(of, out, how, (base, kpis, frontier))
        base = _base(base, results)
        comparison = compare(results, base, kpis)
        refuse = frontier is not None and Path(of).is_dir()
        found, no_frontier = frontier_or_why(results, base, frontier, refuse=refuse)
        title = str(results[base].summary.get("scenario", folder.name))
    page, failed = _page(comparison, folder / "compare.html", title, found)
    if as_json:
        print_json(_as_json(comparison, page) | ({} if found is None else {"frontier": frontier_json(found)}))
    else:
        _print(comparison, title)
        if found is not None:
            print_frontier(found, bool(comparison.hours))
        if page is not None:
            click.echo(f"comparison: {page}")
    if no_frontier:
        click.echo(no_frontier, err=True)
    if failed:
        raise Failed(failed)


def _base(base: str | None, variants: Any) -> str:
    """The variant to compare with: the first one where nobody says and none is called base."""
    return base if base is not None else "base" if "base" in variants else str(next(iter(variants)))


def _page(comparison: Any, path: Path, title: str, frontier: Any) -> tuple[Path | None, str]:
    """Where the page was written or, where it cannot be, why; what was found is told all the same."""
    from opsim.report.comparison import write_comparison

    try:
        return write_comparison(comparison, path, title, frontier), ""
    except OSError as error:
        return None, f"{path}: cannot be written: {error.strerror or error}"


def _results(of: str, out: Path | None, how: dict[str, Any], asked: Any) -> tuple[Path, dict[str, Any]]:
    """asked : base, figures and frontier, which are checked before anything is run"""
    from opsim.cli.compare_asked import check_asked
    from opsim.cli.running import run_variants
    from opsim.results import variants_in

    folder = Path(of)
    if folder.is_dir():
        given = [f"--{name}" for name, value in {"out": out, **how}.items() if value is not None]
        if given:
            raise ValueError(f"{', '.join(given)}: only where a scenario FILE is run; {of} is a folder of results")
        return folder, variants_in(folder)
    base, *others = asked
    folder, _, results = run_variants(
        of, out, check=lambda variants: check_asked(variants, _base(base, variants), *others), **how
    )
    return folder, results


def _print(comparison: Any, title: str) -> None:
    """First the answer in sentences, then a table that fits a screen, then how to read it."""
    from opsim.cli.console import print_table, say, width
    from opsim.report.comparison_table import screen_table
    from opsim.report.comparison_words import answer

    say(f"{title}: variants compared with {comparison.base}")
    for sentence in answer(comparison):
        say(sentence)
    click.echo()
    table = screen_table(comparison, width())
    print_table(f"Differences from {comparison.base}", table.columns, table.rows, words=1)
    for sentence in (*table.left_out, *comparison.short_words):
        say(sentence)


def _as_json(comparison: Any, page: Path | None) -> dict[str, Any]:
    return {
        "base": comparison.base,
        "seed": comparison.seed,
        "pairs": comparison.n,
        "differences": [
            {
                "variant": d.variant,
                **dict(zip(("kpi", "subject", "part", "unit"), d.key)),
                "base": d.base,
                "mean": d.mean,
                **{name: getattr(d.interval, name) for name in ("low", "high", "half_width", "sd", "n")},
                "difference": d.interval.mean,
                "p": d.p,
                "p_holm": d.p_together,
                "variance_ratio": d.variance_ratio,
                "verdict": d.verdict,
            }
            for d in comparison.differences
        ],
        "page": None if page is None else str(page),
    }

"""``opsim compare``: variants against a base, replication by replication.

What ``opsim compare`` is asked for, checked before the runs that take minutes.

Two figures of every variant against each other, as ``opsim compare`` asks for them and tells them.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import click

from opsim.cli.app import mistakes
from opsim.cli.progress import engine_option


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
    from opsim.cli.app import print_json
    from opsim.cli.run_variants import Failed
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
    from opsim.cli.run_variants import run_variants
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
    from opsim.cli.app import print_table, say, width
    from opsim.report.comparison import screen_table
    from opsim.report.comparison_sentences import answer

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


EXAMPLE = "such as throughput_per_h,walked_m"
SECTIONS = {"worker": "workers", "station": "stations", "task": "tasks", "product": "products"}


def check_asked(variants: Mapping[str, Any], base: str, kpis: Sequence[str], frontier: str | None) -> None:
    """variants : as read, none of them run yet; frontier : as ``--frontier`` has it, None: as the scenario has it.

    Raises ValueError with all mistakes, a line each: a base that is not there, names of figures that no run can have.
    """
    from opsim.kpi.catalogue import KPIS
    from opsim.problems import did_you_mean

    wrong = []
    if base not in variants:
        wrong.append(f"no variant {base!r} to compare with; {did_you_mean(base, variants, otherwise='there are')}")
    wrong += [f"no figure {kpi!r}; {did_you_mean(kpi, KPIS)}" for kpi in kpis if kpi not in KPIS]
    made = _made(variants)
    wrong += [_not_made(kpi) for kpi in kpis if kpi in KPIS and _needs(kpi) and kpi not in made]
    texts = frontier_texts(frontier)
    if texts is None:
        first = next(iter(variants.values()))
        texts = list(variants.get(base, first).scenario.frontier or ())
    wrong += [words for text in texts if (words := _wrong(text, variants, made))]
    if len(texts) == 2 and not wrong and _name(texts[0]) == _name(texts[1]):
        wrong.append(f"the frontier needs two different figures, found {_name(texts[0])} twice")
    if wrong:
        raise ValueError("\n".join(dict.fromkeys(wrong)))


def frontier_texts(frontier: str | None) -> list[str] | None:
    """Both figures of ``--frontier``, None where it is not given. Raises ValueError where these are not two."""
    if frontier is None:
        return None
    texts = [text.strip() for text in frontier.split(",")]
    if len(texts) != 2 or not all(texts):
        raise ValueError(f"--frontier: expected two figures and a comma between them, found {frontier!r}; {EXAMPLE}")
    return texts


def _name(text: str) -> str:
    from opsim.kpi.catalogue import read_asked

    return read_asked(text).name


def _made(variants: Mapping[str, Any]) -> set[str]:
    """Figures that some variant asks for."""
    from opsim.kpi.catalogue import read_asked

    scenarios = [loaded.scenario for loaded in variants.values()]
    axes = {read_asked(text).kpi for scenario in scenarios for text in scenario.frontier or ()}
    return axes | {kpi for scenario in scenarios for kpi in scenario.outputs}


def _needs(kpi: str) -> bool:
    from opsim.kpi.catalogue import needs_postures

    return needs_postures([kpi])


def _not_made(kpi: str) -> str:
    return f"{kpi}: it is made where the scenario's 'outputs' list it: add it there"


def _wrong(text: str, variants: Mapping[str, Any], made: set[str]) -> str:
    """What is wrong with one figure; nothing where all is well."""
    from opsim.kpi.catalogue import KPIS, read_asked
    from opsim.problems import did_you_mean

    asked = read_asked(text)
    if asked.kpi not in KPIS:
        return f"no figure {asked.kpi!r}; {did_you_mean(asked.kpi, KPIS)}"
    if _needs(asked.kpi) and asked.kpi not in made:
        return _not_made(asked.kpi)
    if words := next(_subjects_wrong(asked, variants), ""):
        return words
    if not asked.better:
        said = f"write 'more {asked.name}' or 'less {asked.name}'"
        return f"{asked.name}: which way is better depends on who asks: {said}"
    return ""


def _subjects_wrong(asked: Any, variants: Mapping[str, Any]) -> Iterator[str]:
    """Where one of several things has to be named and none is, or one that is not there."""
    from opsim.kpi.catalogue import subject_of
    from opsim.problems import did_you_mean

    kind = subject_of(asked.kpi)
    section = SECTIONS.get(kind)
    scenarios = [loaded.scenario for loaded in variants.values()]
    names = dict.fromkeys(name for scenario in scenarios for name in getattr(scenario, section or "", ()))
    if kind and not asked.subject and not asked.part:
        such = f", such as {asked.kpi}/{next(iter(names))}" if names else f": {asked.kpi}/NAME"
        yield f"{asked.kpi}: it is of each {kind}: say which{such}"
    if names and asked.subject and asked.subject not in (*names, "none"):
        yield f"{asked.name}: no {kind} {asked.subject!r}; {did_you_mean(asked.subject, names)}"


MOST_SHOWN = 12
_VERDICTS = {"front": "on the frontier", "behind": "behind, not clearly", "beaten": "clearly beaten"}


def frontier_asked(results: Mapping[str, Any], base: str, asked: str | None) -> Any:
    """The Frontier that ``--frontier`` or else the scenario asks for; None where neither does.

    Raises ValueError where these are not two figures, NotComparable where a figure is not there.
    """
    from opsim.kpi.catalogue import read_asked
    from opsim.study.pareto import frontier_of

    texts = frontier_texts(asked)
    texts = list(results[base].summary.get("frontier", [])) if texts is None else texts
    if not texts:
        return None
    return frontier_of(results, read_asked(texts[0]), read_asked(texts[1]))


def frontier_or_why(results: Mapping[str, Any], base: str, asked: str | None, *, refuse: bool) -> tuple[Any, str]:
    """The Frontier, or None and why there is none, so that what else was found is told all the same.

    refuse : raise what ``frontier_asked`` raises
    """
    from opsim.study.compare import NotComparable

    try:
        return frontier_asked(results, base, asked), ""
    except NotComparable as error:
        if refuse:
            raise
        return None, f"no picture of two figures against each other: {error}"


def print_frontier(frontier: Any, hours: bool) -> None:
    """A row a variant, and what follows from it in sentences."""
    from opsim.cli.app import print_table, say
    from opsim.report.numbers import plus_minus
    from opsim.report.sections.pareto import axis_name, frontier_sentences, kind_of

    names = [axis_name(key, hours) for key in (frontier.x, frontier.y)]
    largest = [max((abs(getattr(p, side).mean) for p in frontier.points), default=None) for side in "xy"]
    rows = [
        (
            point.variant,
            *(
                plus_minus({"mean": one.mean, "half_width": one.half_width, "unit": key[3]}, most)
                for one, key, most in zip((point.x, point.y), (frontier.x, frontier.y), largest)
            ),
            _VERDICTS[kind_of(point)] if point.x.n and point.y.n else "not shown",
        )
        for point in _shown(frontier.points)
    ]
    print_table("Two figures against each other", ("variant", *names, "verdict"), rows, words=1)
    ways = zip(names, (frontier.better_x, frontier.better_y))
    better = "; ".join(f"{name}: {way} is better" for name, way in ways)
    others = len(frontier.points) - len(rows)
    left_out = [f"{others:,} more variants are in the page."] if others else []
    for sentence in (*left_out, f"{better}.", *frontier_sentences(frontier)):
        say(sentence)


def _shown(points: Any) -> list[Any]:
    """All where they fit a screen, else the first of those on the frontier."""
    return list(points) if len(points) <= MOST_SHOWN else [point for point in points if point.on_front][:MOST_SHOWN]


def frontier_json(frontier: Any) -> dict[str, Any]:
    """For machines."""
    axes = {
        side: {**dict(zip(("kpi", "subject", "part", "unit"), getattr(frontier, side))), "better": better}
        for side, better in (("x", frontier.better_x), ("y", frontier.better_y))
    }
    return {**axes, "pairs": frontier.n, "variants": [_point(point) for point in frontier.points]}


def _point(point: Any) -> dict[str, Any]:
    numbers = {
        side: {name: getattr(getattr(point, side), name) for name in ("mean", "low", "high", "half_width", "n")}
        for side in ("x", "y")
    }
    behind = {"behind": list(point.behind), "clearly_behind": list(point.clearly_behind)}
    return {"variant": point.variant, **numbers, "on_front": point.on_front, **behind}

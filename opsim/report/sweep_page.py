"""A sweep as a page: the answer, what each factor does, the fitted response, and the points."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from opsim.report.frontier import axis_name
from opsim.report.study_page import Section, StudyPage, Table
from opsim.report.sweep_curves import FIT, POINT, curves_html
from opsim.report.sweep_fit_words import fit_sentences
from opsim.report.sweep_map import is_grid, map_svg
from opsim.report.sweep_notes import beside_answer, how_to_read
from opsim.report.sweep_sensitivity import sensitivity_section
from opsim.report.sweep_terms import terms_table
from opsim.report.sweep_tornado import LEGEND, tornado_svg
from opsim.report.sweep_words import changed, largest_of, sentences_of
from opsim.report.words import half_digits, interval_cells, is_number, listing, scale_of

MOST_ROWS = 200
MOST_FIGURES_ON_SCREEN, MOST_ROWS_ON_SCREEN, MOST_FIGURES_ANSWERED = 2, 8, 3
AGAINST = {"base": "the scenario as it is", "mean": "the mean of all points", "fit": "the middle of all factors"}
HOW = {
    "base": "Each factor alone, the others as the scenario has them: what two of them do together is not seen.",
    "mean": "Each factor's levels, averaged over all combinations of the others.",
    "fit": "By the fitted response, with the other factors in the middle of their ranges.",
}


def sweep_page(name: str, points: Any, found: Sequence[Any], replications: int, seed: int) -> StudyPage:
    """points : the Points; found : a Found for each figure"""
    told = found[:MOST_FIGURES_ANSWERED]
    answer = [sentence for one in told for sentence in sentences_of(one, points, one is told[0])]
    if len(found) > MOST_FIGURES_ANSWERED:
        others = listing([axis_name(one.key) for one in found[MOST_FIGURES_ANSWERED:]])
        answer.append(f"Below, too: {others}.")
    answer += beside_answer(points, found)
    sections = [section for place, one in enumerate(found) for section in _sections(one, points, place)]
    return StudyPage(
        title=name,
        kind="sweep",
        answer=answer,
        sections=[*sections, points_section(points, found)],
        words=how_to_read(points, found, replications, seed),
    )


def _sections(found: Any, points: Any, place: int) -> Iterator[Section]:
    name, largest, unit = axis_name(found.key), largest_of(found), found.key[3]
    on_screen = place < MOST_FIGURES_ON_SCREEN and (place + 1) * len(points.factors) <= MOST_ROWS_ON_SCREEN
    if found.swings:
        yield Section(
            f"{name}: what each factor does",
            [*([] if place else [HOW[found.how]]), *(fit_sentences(found) if found.how == "fit" else [])],
            swings_table(found),
            tornado_svg(found.swings, unit, largest, AGAINST[found.how]),
            LEGEND,
            on_screen or place == 0,
        )
    if found.sensitivity:
        yield sensitivity_section(found, points.design, on_screen)
    if points.design not in ("sobol_indices", "morris", "one_at_a_time"):
        yield from _response(found, points, name, largest)


def swings_table(found: Any) -> Table:
    """A row a factor: between which levels the figure rises most, and by how much."""
    unit, largest = found.key[3], largest_of(found)
    rows = [
        (
            one.name,
            changed(one.rise, unit, largest),
            *(("", "") if one.nothing else (one.levels[one.least].name, one.levels[one.most].name)),
            _told(one, found),
        )
        for one in found.swings
    ]
    return Table(("factor", "difference", "lowest at", "highest at", ""), rows)


def _told(one: Any, found: Any) -> str:
    if found.how == "fit" and not found.response.trusted:
        return "fit not trusted"
    return "clear" if one.clear else "no effect" if one.nothing else "not told from chance"


def _response(found: Any, points: Any, name: str, largest: float | None) -> Iterator[Section]:
    legend = [
        (POINT, POINT, "mean of a level over all others" if found.how == "mean" else "a point, with its interval")
    ]
    if found.response is not None:
        legend.append((FIT, FIT, "fitted response, averaged over the other factors"))
    curves = curves_html(found, points, largest)
    table = None if found.response is None else terms_table(found)
    said = [] if found.how == "fit" else fit_sentences(found)
    yield Section(f"{name}: over each factor", said, table, curves, legend)
    picture = map_svg(found, points, largest)
    if picture:
        of = "Means of the points." if is_grid(points) else "The fitted response; rings are the points."
        yield Section(f"{name}: over both factors", [of], picture=picture)


def points_section(points: Any, found: Sequence[Any]) -> Section:
    """A row a point; of many only the first ones."""
    n = len(points.values)
    rows = []
    for row in range(min(n, MOST_ROWS)):
        values = [factor.words(value) for factor, value in zip(points.factors, points.values[row])]
        rows.append([str(row + 1), *values, *(_mean(one, row) for one in found)])
    units = [scale_of(one.key[3], largest_of(one))[1] for one in found]
    names = [", ".join(filter(None, (axis_name(one.key), unit))) for one, unit in zip(found, units)]
    columns = ("point", *(factor.path for factor in points.factors), *names)
    more = f"The first {MOST_ROWS} of {n:,} points; all of them are in figures.parquet." if n > MOST_ROWS else ""
    return Section("Points", [more] if more else [], Table(columns, rows, words=1 + len(points.factors)))


def _mean(found: Any, row: int) -> str:
    """``60.1 ± 1.0``; the unit stands over the column."""
    one, largest = found.means[row], largest_of(found)
    factor, _ = scale_of(found.key[3], largest)
    cells = interval_cells(
        {
            "mean": one.mean,
            "low": one.low,
            "high": one.high,
            "half_width": one.half_width,
            "n": one.n,
            "unit": found.key[3],
        },
        largest,
    )
    if not is_number(one.half_width) or not one.half_width:
        return cells["mean"]
    return f"{cells['mean']} ± {half_digits(one.mean * factor, one.half_width * factor)}"

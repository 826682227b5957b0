"""What a sweep says beside its answer: what was not varied or not used, and how its page is to be read.

A sweep as a page: the answer, what each factor does, the fitted response, and the points.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from opsim.kpi.catalogue import MORE
from opsim.report.numbers import half_digits, interval_cells, is_number, largest_of, listing, scale_of
from opsim.report.page import StudyPage, StudySection, Table
from opsim.report.sections.pareto import axis_name, frontier_section
from opsim.report.studies.response_surface import is_grid, map_svg, sensitivity_section, terms_table
from opsim.report.studies.sweep_charts import FIT, LEGEND, POINT, curves_html, tornado_svg
from opsim.report.studies.sweep_sentences import changed, fit_sentences, sentences_of
from opsim.study.pareto import Frontier, placed

DESIGNS = {
    "grid": "every combination",
    "list": "points given one by one",
    "one_at_a_time": "one factor at a time, the others as they are",
    "latin_hypercube": "Latin hypercube",
    "sobol": "scrambled Sobol sequence",
    "sobol_indices": "Saltelli's design for Sobol indices",
    "morris": "Morris' paths, one factor moving at a time",
}


def beside_answer(points: Any, found: Sequence[Any]) -> list[str]:
    """What else has to be known. points : the Points; found : a Found for each figure"""
    return [*_not_varied(points, found), *points.warned, *_hours(points, found)]


def _not_varied(points: Any, found: Sequence[Any]) -> Iterator[str]:
    """A word on factors of which there is one value only."""
    single = [factor.path for factor in points.factors if not factor.is_range and len(factor.values) == 1]
    if points.design == "one_at_a_time" and found:  # there, what the scenario has is another value
        single = [path for path in single if path not in [one.name for one in found[0].swings]]
    if single:
        has = "has one value, so it was" if len(single) == 1 else "have one value each, so they were"
        yield f"{listing(single)} {has} not varied."


def _hours(points: Any, found: Sequence[Any]) -> Iterator[str]:
    """A word on figures per scheduled hour where it is varied what is scheduled."""
    from opsim.study.compare import PER_CALENDAR_HOUR, PER_SCHEDULED_HOUR

    varied = [f.path for f in points.factors if {"shift", "shifts"} & set(f.path.split("."))]
    of = [axis_name(one.key) for one in found if one.key[0] in PER_SCHEDULED_HOUR]
    if varied and of:
        yield (
            f"{listing(varied)} may change which hours are scheduled, and {listing(of)} is per scheduled hour: points "
            f"with other hours are not comparable in it. Take --figure {PER_CALENDAR_HOUR}."
        )


def how_to_read(points: Any, found: Sequence[Any], replications: int, seed: int) -> list[str]:
    """What the page says of its intervals and its fit."""
    n = len(points.values)
    each = "1 replication" if replications == 1 else f"{replications} replications"
    said = [
        f"{n:,} points ({DESIGNS[points.design]}), {each} of each, with the same random numbers at every point "
        f"(seed {seed}).",
        *points.words,
    ]
    if any(one.swings for one in found):
        said.append(
            "Differences are paired, replication by replication; each 95 % interval is for its factor alone, and "
            "counts that the two levels furthest apart were picked (Bonferroni). 'Clear' holds for all factors of a "
            "figure together (Holm)."
        )
    if any(one.how == "fit" and one.swings for one in found):
        said.append(
            "Differences by the fitted response carry its own error too: by how much it misses the points beyond luck."
        )
    if any(one.response is not None for one in found):
        said.append(
            "The fitted response is the polynomial, linear or with squares and interactions, that misses points left "
            "out by least. The intervals of its terms say how replications differ, not how far the polynomial is from "
            "the truth; the error for points left out says that. (Kleijnen 2015; Montgomery 2013)"
        )
    if any(one.sensitivity for one in found):
        said.append("Intervals are by bootstrap over the design (95 %), by SALib (Saltelli 2010; Morris 1991).")
    if any(one.best is not None for one in found):
        said.append(
            "The best of many points is partly lucky: 'opsim select' says with a promise which one is best, on fresh "
            "random numbers."
        )
    return said


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
        sections=[*_against_each_other(points, found), *sections, points_section(points, found)],
        words=how_to_read(points, found, replications, seed),
    )


def _against_each_other(points: Any, found: Sequence[Any]) -> Iterator[StudySection]:
    """The first two figures of which one way is better, against each other."""
    frontier = frontier_of_points(points, found)
    if frontier is not None:
        yield StudySection(**frontier_section(frontier))


def frontier_of_points(points: Any, found: Sequence[Any]) -> Frontier | None:
    """A point each, by its values in words; None without two such figures, and of one point or very many."""
    asked = [one for one in found if one.better][:2]
    names = [", ".join(factor.words(v) for factor, v in zip(points.factors, row)) for row in points.values]
    if len(asked) < 2 or not 1 < len(names) <= MOST_ROWS:
        return None
    values = {name: np.stack([one.values[row] for one in asked]) for row, name in enumerate(names)}
    x, y = asked
    signs = np.array([1.0 if one.better == MORE else -1.0 for one in asked])
    return Frontier(x.key, y.key, x.better, y.better, placed(values, signs), x.replications)


def _sections(found: Any, points: Any, place: int) -> Iterator[StudySection]:
    name, largest, unit = axis_name(found.key), largest_of(found), found.key[3]
    on_screen = place < MOST_FIGURES_ON_SCREEN and (place + 1) * len(points.factors) <= MOST_ROWS_ON_SCREEN
    if found.swings:
        yield StudySection(
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


def _response(found: Any, points: Any, name: str, largest: float | None) -> Iterator[StudySection]:
    legend = [
        (POINT, POINT, "mean of a level over all others" if found.how == "mean" else "a point, with its interval")
    ]
    if found.response is not None:
        legend.append((FIT, FIT, "fitted response, averaged over the other factors"))
    curves = curves_html(found, points, largest)
    table = None if found.response is None else terms_table(found)
    said = [] if found.how == "fit" else fit_sentences(found)
    yield StudySection(f"{name}: over each factor", said, table, curves, legend)
    picture = map_svg(found, points, largest)
    if picture:
        of = "Means of the points." if is_grid(points) else "The fitted response; rings are the points."
        yield StudySection(f"{name}: over both factors", [of], picture=picture)


def points_section(points: Any, found: Sequence[Any]) -> StudySection:
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
    return StudySection("Points", [more] if more else [], Table(columns, rows, words=1 + len(points.factors)))


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

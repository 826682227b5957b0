"""A choice of the best, as a page and a screen: who is best, who was out when, limits, what a search tried."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from opsim.kpi.catalogue import MORE
from opsim.report.page import StudyPage, StudySection, Table
from opsim.report.plot.plotly import ACCENT, MUTED
from opsim.report.sections.pareto import axis_name
from opsim.report.studies.selection_charts import (
    OUT,
    Bar,
    Runner,
    columns_of,
    means_svg,
    order_of,
    race_svg,
    rows_of,
    scale_in,
    trials_svg,
)
from opsim.report.studies.selection_sentences import allowed, amount, answer_of, exact
from opsim.study.intervals import t_interval

MOST_ON_SCREEN, MOST_TRIALS, MOST_DRAWN = 12, 15, 40
MOST_POINTS = 200
"""Of a line in the race."""
BETTER_KNOWN = {
    "kn": "Proven where the best is at least that much better than every other (Kim & Nelson 2001). Where several are "
    "closer, that the chosen one is within it of the best is what experience shows, not a theorem.",
    "rinott": "Proven whatever the means are (Rinott 1978, Nelson & Matejcik 1995).",
    "dudewicz-dalal": "Proven where the best is at least that much better than every other (Dudewicz & Dalal 1975). "
    "Its means weigh the first stage apart from the second, so that they are a little beside the plain ones.",
    "ocba": "OCBA (Chen et al. 2000) promises nothing beforehand: the probability is one of the means and spreads that "
    "were seen, a bound over all pairs (Bonferroni) by Student's t, as few replications know spreads badly.",
}


def select_page(found: Any, title: str) -> StudyPage:
    """found : of ``opsim.study.select.study``"""
    return StudyPage(title, "select", answer_of(found), list(_sections(found)), list(_words(found)))


def _sections(found: Any) -> Iterator[StudySection]:
    selection = found.selection
    if selection is not None:
        rows = rows_of(found)
        words = 3 if found.called else 2
        table = Table(columns_of(found), rows[:MOST_ON_SCREEN], words)
        more = len(rows) - MOST_ON_SCREEN
        yield StudySection(
            f"Who is best: {axis_name(found.key)}",
            [f"{more} others are shown below these on the page."] if more > 0 else [],
            table,
            on_screen=True,
        )
        if more > 0:
            yield StudySection("The others", table=Table(columns_of(found), rows[MOST_ON_SCREEN:], words))
        yield from _pictures(found)
    if found.fresh is not None:
        yield _fresh_section(found)
    if found.searched is not None:
        yield _search_section(found)


def _pictures(found: Any) -> Iterator[StudySection]:
    factor, unit = scale_in(found, 0)
    order = order_of(found)
    runners = [_runner(found, i, factor) for i in order[:MOST_DRAWN]]
    figure = axis_name(found.key)
    if all(len(one.n) > 1 for one in runners):
        kinds = {one.kind for one in runners}
        legend = [
            (edge, edge, words)
            for edge, words, of in (
                (ACCENT, "the best" if found.winner else "still in", ("best", "left")),
                (MUTED, "beaten by another", ("beaten",)),
                (MUTED, "not the best", ("other",)),
                (OUT, "beyond a limit", ("limit",)),
            )
            if kinds.intersection(of)
        ]
        said = "The mean of each as replications come in" + (
            "" if found.apart else "; a line ends where it was thrown out"
        )
        yield StudySection("The race", [f"{said}."], picture=race_svg(runners, unit, figure), legend=legend)
    yield StudySection(
        f"{figure}: means with 95 % intervals",
        ["Each by itself; with common random numbers differences are known better than this shows."]
        if not found.apart
        else [],
        picture=means_svg(_bars(found, 0), unit),
    )
    for place, (limit, key) in enumerate(zip(found.limits, found.keys), 1):
        scale, word = scale_in(found, place)
        line = limit.bound * scale, allowed(limit, key[3])
        yield StudySection(f"{axis_name(key)}: the limit", picture=means_svg(_bars(found, place), word, line))


def _kind(found: Any, i: int) -> str:
    name = found.selection.systems[i]
    if name == found.winner:
        return "best"
    out = next((one for one in found.selection.out if one.system == name), None)
    if out is None:
        return "other" if found.apart else "left"
    return "limit" if out.limit else "beaten"


def _runner(found: Any, i: int, factor: float) -> Runner:
    """Means after 2, 3, ... replications, at most so many points of them."""
    values = found.selection.values[i][: found.selection.n[i], 0]
    n = np.unique(np.linspace(2, max(2, len(values)), min(MOST_POINTS, max(1, len(values) - 1))).round().astype(int))
    n = n[n <= len(values)]
    means = np.cumsum(values)[n - 1] / n * factor
    return Runner(found.selection.systems[i], _kind(found, i), [int(one) for one in n], [float(one) for one in means])


def _bars(found: Any, column: int) -> list[Bar]:
    selection, factor = found.selection, scale_in(found, column)[0]
    bars = []
    for i in order_of(found)[:MOST_DRAWN]:
        of = t_interval(selection.values[i][: selection.n[i], column])
        mean = selection.means[i] if column == 0 else of.mean
        low, high = (mean - of.half_width) * factor, (mean + of.half_width) * factor
        bars.append(Bar(selection.systems[i], _kind(found, i), low, mean * factor, high))
    return bars


def _fresh_section(found: Any) -> StudySection:
    fresh = found.fresh
    rows = []
    for key, chosen, base in zip((found.key, *found.keys), fresh.chosen, fresh.base):
        row = [axis_name(key), amount(chosen.mean, key[3], chosen.half_width)]
        rows.append([*row, *([] if fresh.difference is None else [amount(base.mean, key[3], base.half_width)])])
    columns = ["figure", found.winner, *([] if fresh.difference is None else [found.base])]
    numbers = f"Replications {fresh.first:,} to {fresh.first + fresh.n - 1:,}, which had no part in the choice"
    same = "" if fresh.difference is None else "; both have the same random numbers"
    return StudySection("Looked at again on fresh replications", [f"{numbers}{same}."], Table(columns, rows))


def _search_section(found: Any) -> StudySection:
    tried, (factor, unit) = found.searched, scale_in(found, 0)
    trials = tried.trials
    picture = trials_svg(
        [trial.mean * factor for trial in trials],
        [trial.within for trial in trials],
        list(tried.finalists.values()),
        unit,
        axis_name(found.key),
    )
    sign = 1 if found.better == MORE else -1
    known = [i for i, trial in enumerate(trials) if not trial.refused]
    best = sorted(known, key=lambda i: (not trials[i].within, -sign * trials[i].mean, i))[:MOST_TRIALS]
    paths = list(trials[0].changes)
    rows = [
        [
            str(i + 1),
            *(str(trials[i].changes[path]) for path in paths),
            amount(trials[i].mean, found.key[3]),
            _went(found, i),
        ]
        for i in best
    ]
    refused = next((trial.refused for trial in trials if trial.refused), "")
    said = [f"Means over {tried.replications} replications, the same in all; the best of many looks better than it is."]
    if refused:
        said.append(f"Some combinations could not be run; the first: {refused}")
    legend = [(ACCENT, ACCENT, "went on"), (ACCENT, "#ffffff", "keeps the limits" if found.limits else "tried")]
    if found.limits:
        legend.append((MUTED, "#ffffff", "beyond a limit"))
    return StudySection(
        "What the search tried", said, Table(["trial", *paths, "mean", ""], rows, len(paths) + 1), picture, legend
    )


def _went(found: Any, i: int) -> str:
    if i in found.searched.finalists.values():
        return "went on"
    return "" if found.searched.trials[i].within else "beyond a limit"


def _words(found: Any) -> Iterator[str]:
    unit = found.key[3]
    if found.factors:
        yield f"{'; '.join(f'{name} is {path}' for name, path in found.factors.items())}."
    small = exact(found.indifference, unit)
    selection = found.selection
    said = found.indifference_said
    of_base = f" ({said} of {found.base}, on replications of its own)" if said.endswith("%") and unit != "share" else ""
    yield f"A difference of {small}{of_base} or less does not matter: it is what was asked."
    if selection is not None:
        yield f"Promise of {selection.procedure}: {selection.promise}. {BETTER_KNOWN[selection.procedure]}"
        yield f"It assumes that {'; '.join(selection.assumes)}."
        asked, used = sum(selection.asked), sum(selection.n)
        if selection.procedure == "kn":
            rest = f"; {asked - used:,} were run and not needed" if asked > used else ""
            yield (
                f"Replications came in batches, and were judged one by one as if they came alone, so batches change "
                f"nothing of the promise: {used:,} decided{rest}."
            )
        luck = "have numbers of their own" if found.apart else "with the same number have the same random numbers"
        yield f"Replications of the variants {luck}; the choice began with number {found.first:,}."
    for limit, key in zip(found.limits, found.keys):
        near = exact(limit.tolerance, key[3])
        held = f"{limit.name} is held {allowed(limit, key[3])}, on average"
        yield f"{held}; a variant within {near} of that may be called either."
    if selection is not None:
        yield "Intervals (±) are 95 %, of each figure alone; of who was out early they are from few replications."

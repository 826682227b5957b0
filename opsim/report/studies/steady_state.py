"""What a long run says, as an engineer would: the figures, and whether to believe them.

The three pictures of a long run: how it settles (Welch), its batch means, and how alike neighbours are.

A long run told once, for a screen and for a page.

The series behind a suggested warm-up, as PNG or SVG.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from opsim.files import whole_file
from opsim.report.numbers import (
    ABSENT,
    SERIES_NAMES,
    batch_words,
    digits,
    is_number,
    kpi_name,
    length_words,
    listing,
    mean_words,
    quantity,
    reasons,
    scale_of,
    time_words,
)
from opsim.report.page import StudyPage, StudySection, Table
from opsim.report.plot.plotly import ACCENT, GRID, INK, MUTED
from opsim.report.plot.svg_chart import SmallChart, around, panels
from opsim.study.long_run.batching import MOST_TIMES
from opsim.study.long_run.diagnostics import AGAIN

if TYPE_CHECKING:
    from opsim.study.long_run.steady_state import LongRun

MAIN = ("throughput_per_h", "time_in_system_s", "work_in_progress")
"""The figures of which sentences speak; the others are in the table."""
_WHY = {
    "own": "the run's own warm-up",
    "MSER-5": "by MSER-5, longer than the run's own warm-up",
    "asked": "as asked",
}


def answer(run: LongRun) -> list[str]:
    """Sentences, the figures first, then whether they are to be believed. run : a LongRun"""
    told = [one for one in run.series if one.name in MAIN]
    known = [one for one in told if one.batches is not None]
    if not known:
        return ["Too few jobs finish to say anything: make the run longer, with --horizon."]
    figures = [
        f"{SERIES_NAMES[one.name]}: {_mean(one)}, from {batch_words(one)}{_after(run, one, known)}." for one in known
    ]
    return [*figures, _verdict(list(_doubts(run, told)), list(_cares(run, told)))]


def _mean(one: Any) -> str:
    """With a warning where the interval is not to be trusted."""
    doubted = any(flag.serious for flag in one.flags)
    return f"{mean_words(one)} (± not to be trusted)" if doubted else mean_words(one)


def _after(run: LongRun, one: Any, known: Sequence[Any]) -> str:
    if one is not known[0] or run.left_out_s <= 0:
        return ""
    return f" after leaving out the first {time_words(run.left_out_s)} ({_WHY[run.why]})"


def _verdict(doubts: Sequence[str], cares: Sequence[str]) -> str:
    first, *others = [*doubts, *cares, ""]
    rest = "".join(f" {text[0].upper()}{text[1:]}" for text in others if text)
    if first:
        return f"{'Not believable yet' if doubts else 'Believe it with care'}: {first}{rest}"
    return (
        "Nothing speaks against it: no sign that batches are alike or that anything keeps growing, and no test finds "
        "the start in it."
    )


def _flagged(told: Sequence[Any], code: str) -> list[tuple[Any, Any]]:
    return [(one, flag) for one in told for flag in one.flags if flag.code == code]


def _doubts(run: LongRun, told: Sequence[Any]) -> Iterator[str]:
    for_good = _flagged(told, "unstable")
    if for_good:
        said = f"more comes than leaves, so that these keep growing: {_rates(for_good)}. No longer run helps."
        yield " ".join([said, *_full(run)])
    growing, short = _flagged(told, "growing"), _flagged(told, "too_short")
    # One figure of how long to run, for both reasons.
    longest = max([flag.by for _, flag in short] + ([AGAIN] if growing else []), default=1.0)
    horizon = f"--horizon '{_horizon(run, longest)}'"
    if growing:
        yield (
            f"within this run these keep growing: {_rates(growing)}. Either more comes than leaves, or the run is too "
            f"short to tell. Run {math.ceil(longest)} times as long: {horizon}."
        )
    if short:
        why = "; ".join(dict.fromkeys(_why_short(one) for one, _ in short))
        again = "" if growing else f" {_times(longest)} as long would do: {horizon}."
        yield f"the run is too short for {_names(short)}: {why}.{again}"
    if run.part_of_days:
        yield "the floor keeps hours, and ten whole days at least are needed, as parts of days are not alike."


def _rates(flagged: Sequence[tuple[Any, Any]]) -> str:
    return listing([f"{SERIES_NAMES[one.name].lower()} ({_per_day(one, flag.by)})" for one, flag in flagged])


def _full(run: LongRun) -> Iterator[str]:
    """What shows, apart from the growth itself, that more comes than leaves."""
    if run.full_stations:
        yield f"Never without a job: {listing(list(run.full_stations))}."
    if run.nobody_free:
        yield "Nobody is ever free."


def _why_short(one: Any) -> str:
    if one.batches.long_enough:
        return "more than half of it is warm-up"
    if one.batches.independent:
        return "replications are independent, but each is too short to forget its start"
    return "there are not even ten independent batches"


def _cares(run: LongRun, told: Sequence[Any]) -> Iterator[str]:
    start = _flagged(told, "start_left")
    if start:
        said = listing([f"{SERIES_NAMES[one.name].lower()} ({_by(one, flag.by)})" for one, flag in start])
        yield f"the second half is not as the first quarter in {said}: leave out more with --warm-up, or run longer."
    alike = _flagged(told, "autocorrelated")
    if alike:
        yield f"batches that follow one another are alike in {_names(alike)}, so that its ± is too narrow."
    few = _flagged(told, "few_events")
    if few:
        yield f"only {min(flag.by for _, flag in few):,.0f} jobs are counted."
    unsettled = [one for one in told if one.name != "time_in_system_s" and one.warm_up_s is None]
    doubted = any(_flagged(told, code) for code in ("unstable", "growing", "too_short"))
    if unsettled and not doubted and not run.part_of_days:
        yield f"MSER-5 finds no warm-up to believe in {listing([SERIES_NAMES[one.name].lower() for one in unsettled])}."


def _names(flagged: Sequence[tuple[Any, Any]]) -> str:
    return listing([SERIES_NAMES[one.name].lower() for one, _ in flagged])


def _per_day(one: Any, by: float) -> str:
    """Growth over the span of the batches, as people count it."""
    day = one.span_s >= 86_400
    rate = by / one.span_s * (86_400 if day else 3600)
    return f"+{quantity(rate, one.unit, abs(rate) / 10)} {'a day' if day else 'an hour'}"


def _by(one: Any, by: float) -> str:
    return f"{'+' if by > 0 else ''}{quantity(by, one.unit, abs(by) / 10)}"


def _times(factor: float) -> str:
    if factor >= MOST_TIMES:
        return f"At least {MOST_TIMES:.0f} times"
    return "About twice" if factor == 2 else f"About {math.ceil(factor)} times"


def _horizon(run: LongRun, factor: float) -> str:
    """What to ask for: the warm-up and so many times the rest, rounded up to two digits of hours."""
    hours = (run.left_out_s + factor * (run.horizon_s - run.left_out_s)) / 3600
    step = 10.0 ** max(0, math.floor(math.log10(max(hours, 1.0))) - 1)
    return f"{math.ceil(hours / step) * step:g} h"


MOST_POINTS = 400
WARM = "#E69F00"
SETTLING_LEGEND = (
    (GRID, GRID, "average of the replications"),
    (ACCENT, ACCENT, "smoothed (Welch)"),
    (WARM, WARM, "left out"),
)
BATCH_LEGEND = ((ACCENT, ACCENT, "mean of a batch"), (ACCENT, "#cfe3f0", "95 % interval of the mean"))


def settling_svg(run: LongRun) -> str:
    """A chart a series that goes by time. run : a LongRun"""
    return panels(_settling(one, run) for one in run.series if one.curve.size)


def batches_svg(run: LongRun) -> str:
    """A chart a series that has batches."""
    return panels(_batches(one) for one in run.series if one.batches is not None)


def correlogram_svg(run: LongRun) -> str:
    """A chart a series that has batches."""
    return panels(_correlogram(one) for one in run.series if one.correlogram.size > 1)


def _settling(one: Any, run: LongRun) -> SmallChart:
    factor, unit = scale_of("s", run.horizon_s)
    values, word = _in_unit(one, one.curve)
    smooth, _ = _in_unit(one, one.smooth)
    at = (np.arange(values.size) + 0.5) * run.slice_s * factor
    y = _reached(smooth, values)
    chart = SmallChart(
        _title(one, word),
        (0.0, run.horizon_s * factor),
        y,
        f"time, {unit}",
        f"{SERIES_NAMES[one.name]} over time, smoothed",
    )
    if run.left_out_s > 0:
        chart.box((0.0, run.left_out_s * factor), y, WARM, 0.25)
    chart.line(*_thinned(at, values), GRID, 1.0)
    chart.line(*_thinned(at[: smooth.size], smooth), ACCENT, 2.0)
    return chart


def _batches(one: Any) -> SmallChart:
    found = one.batches
    means, word = _in_unit(one, found.means.ravel())
    factor = _factor(one)
    known = np.isfinite(found.half_width)
    edges = [found.low * factor, found.high * factor] if known else [found.mean * factor]
    at = np.arange(1, means.size + 1)
    said = (
        f"{SERIES_NAMES[one.name]}: {means.size} batch means from {digits(means.min())} to {digits(means.max())} {word}"
    )
    chart = SmallChart(_title(one, word), (0.0, means.size + 1.0), around([*means, *edges]), "batch", said)
    if known:
        chart.box((0.0, means.size + 1.0), (edges[0], edges[1]), ACCENT, 0.18)
    chart.level(found.mean * factor, ACCENT)
    chart.dots(at.tolist(), means.tolist(), ACCENT)
    return chart


def _correlogram(one: Any) -> SmallChart:
    lags = np.arange(one.correlogram.size)
    low = min(-0.25, float(one.correlogram.min()) - 0.05)
    said = f"{SERIES_NAMES[one.name]}: correlation of neighbours {one.correlogram[1]:.2f}"
    chart = SmallChart(SERIES_NAMES[one.name], (-0.8, lags.size - 0.2), (low, 1.0), "pieces apart", said)
    chart.bars(lags.tolist(), one.correlogram.tolist(), ACCENT)
    chart.level(0.0, INK)
    for edge in (-1, 1):
        chart.level(edge * 1.96 / np.sqrt(max(1, one.values)), MUTED, dashed=True)
    return chart


def _title(one: Any, word: str) -> str:
    return SERIES_NAMES[one.name] if word in ("", "jobs", "people") else f"{SERIES_NAMES[one.name]}, {word}"


def _factor(one: Any) -> float:
    return scale_of(one.unit, None if one.batches is None else one.batches.mean)[0]


def _in_unit(one: Any, values: np.ndarray) -> tuple[np.ndarray, str]:
    factor, word = scale_of(one.unit, None if one.batches is None else one.batches.mean)
    return values * factor, word


def _reached(smooth: np.ndarray, values: np.ndarray) -> tuple[float, float]:
    """What the smooth curve reaches, with room for most of the values: spikes of thin slices stand on the edge."""
    low, high = np.quantile(values, [0.01, 0.99])
    return around([0.0, float(low), float(high), *smooth.tolist()], with_zero=True)


def _thinned(x: np.ndarray, y: np.ndarray) -> tuple[list[float], list[float]]:
    """Means of neighbours where there are more points than a chart can show."""
    each = -(-x.size // MOST_POINTS)
    n = x.size // each * each
    first, second = (of[:n].reshape(-1, each).mean(axis=1).tolist() for of in (x, y))
    return first, second


KIND = "long run"


def long_run_page(run: LongRun) -> StudyPage:
    """run : a LongRun"""
    table = Table(("figure", "mean", "batches", "each", "neighbours", "check", "judged"), _rows(run), words=1)
    return StudyPage(
        f"{run.scenario}, {run.variant}" if run.variant else run.scenario,
        KIND,
        (_what(run), *answer(run)),
        (
            StudySection("Figures of the steady state", table=table, on_screen=True),
            StudySection(
                "How it settles",
                (
                    "Where the blue line has become level the floor has settled; what comes before has to be left out. "
                    "By eye, after Welch 1983; MSER-5 says the same by a rule (opsim warm-up).",
                ),
                picture=settling_svg(run),
                legend=SETTLING_LEGEND,
            ),
            StudySection(
                "Batch means",
                ("They should scatter around their mean without a trend, and one should say nothing of the next.",),
                picture=batches_svg(run),
                legend=BATCH_LEGEND,
            ),
            StudySection(
                "How alike neighbours are",
                (
                    "The correlation of pieces of the run so many pieces apart, 400 pieces a replication at most. It "
                    "has to fall between the dashed lines well before a batch is over.",
                ),
                picture=correlogram_svg(run),
            ),
        ),
        _words(),
    )


def _what(run: LongRun) -> str:
    noun = "1 replication" if run.replications == 1 else f"{run.replications} replications"
    return f"{noun} of {time_words(run.horizon_s)}, seed {run.seed}."


def _rows(run: LongRun) -> list[tuple[str, ...]]:
    return [_row(one) for one in run.series]


def _row(one: Any) -> tuple[str, ...]:
    found = one.batches
    if found is None:
        return (SERIES_NAMES[one.name], ABSENT, "0", ABSENT, ABSENT, ABSENT, reasons(one))
    check = found.half_width_overlapping
    factor, unit = scale_of(one.unit, found.mean)
    return (
        SERIES_NAMES[one.name],
        mean_words(one),
        str(found.n),
        length_words(one),
        digits(found.lag_one, 0.1) if is_number(found.lag_one) else ABSENT,
        f"± {digits(check * factor, check * factor)} {unit}".strip() if is_number(check) else ABSENT,
        reasons(one),
    )


def _words() -> tuple[str, ...]:
    return (
        "± is the 95 % interval of the mean from batches that follow one another (Law & Carson 1979): as many as may "
        "be taken for independent, 40 at most and 10 at least, all replications together; else a whole replication "
        "each, from five replications on.",
        "neighbours: correlation of pieces a tenth of a batch long; above 0.4 the batches are not independent, or the "
        "replications too short to forget their start. "
        "check: the half-width from batches that overlap (Meketon & Schmeiser 1984); it should be near the other.",
        "Jobs finished are counted per hour of the calendar, good or not; time in system job by job, by when they "
        "finish. Where neighbours are not alike each flag is raised by luck alone in one run of a hundred; growth far "
        "more often in a short run of a floor that is nearly full. That nothing is flagged is no proof.",
    )


def draw_warm_up(found: Sequence[Any], path: str | Path, title: str) -> Path:
    """One panel a series (each a WarmUp): slices, their batches of five, and what is left out in grey."""
    from matplotlib import rc_context
    from matplotlib.figure import Figure

    path = Path(path)
    style: Any = {"svg.fonttype": "none", "svg.hashsalt": "opsim", "text.parse_math": False}
    with rc_context(style), whole_file(path) as temporary:
        figure = Figure(figsize=(9.0, 0.6 + 2.4 * len(found)), layout="constrained")
        figure.suptitle(title, x=0.01, ha="left", fontsize=11, color=INK)
        for axes, warm_up in zip(figure.subplots(len(found), 1, squeeze=False)[:, 0], found):
            _panel(axes, warm_up)
        kind = path.suffix.removeprefix(".").lower()
        figure.savefig(temporary, format=kind, dpi=150, metadata={"Date": None} if kind == "svg" else None)
    return path


def _panel(axes: Any, warm_up: Any) -> None:
    n = warm_up.series.size
    factor, unit = scale_of("s", n * warm_up.slice_s)
    at = (np.arange(n) + 0.5) * warm_up.slice_s * factor
    batches = warm_up.series[: n // 5 * 5].reshape(-1, 5).mean(axis=1)
    axes.plot(at, warm_up.series, color=GRID, linewidth=0.8)
    axes.plot(at[2::5][: batches.size], batches, color=ACCENT, linewidth=1.3)
    words = "no warm-up found: the run is too short to tell"
    if warm_up.until_s is not None:
        axes.axvspan(0, warm_up.until_s * factor, color=MUTED, alpha=0.18, linewidth=0)
        words = (
            f"warm-up {quantity(warm_up.until_s, 's', 5 * warm_up.slice_s)}" if warm_up.until_s else "no warm-up needed"
        )
    axes.set_title(f"{kpi_name(warm_up.name)}: {words}", loc="left", fontsize=10, color=INK)
    axes.set_xlabel(f"time since the start, {unit}", fontsize=9, color=MUTED)
    axes.set_ylabel(scale_of(warm_up.unit, None)[1], fontsize=9, color=MUTED)
    axes.set_xlim(0, n * warm_up.slice_s * factor)
    axes.tick_params(labelsize=8)
    axes.spines[["top", "right"]].set_visible(False)

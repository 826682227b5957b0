"""A long run told once, for a screen and for a page."""

from __future__ import annotations

from typing import Any

from opsim.report.long_run_answer import answer
from opsim.report.long_run_pictures import (
    BATCH_LEGEND,
    SETTLING_LEGEND,
    batches_svg,
    correlogram_svg,
    settling_svg,
)
from opsim.report.long_run_words import NAMES, length_words, mean_words, reasons, time_words
from opsim.report.study_page import Section, StudyPage, Table
from opsim.report.words import ABSENT, digits, is_number, scale_of

KIND = "long run"


def long_run_page(run: Any) -> StudyPage:
    """run : a LongRun"""
    table = Table(("figure", "mean", "batches", "each", "neighbours", "check", "judged"), _rows(run), words=1)
    return StudyPage(
        f"{run.scenario}, {run.variant}" if run.variant else run.scenario,
        KIND,
        (_what(run), *answer(run)),
        (
            Section("Figures of the steady state", table=table, on_screen=True),
            Section(
                "How it settles",
                (
                    "Where the blue line has become level the floor has settled; what comes before has to be left out. "
                    "By eye, after Welch 1983; MSER-5 says the same by a rule (opsim warm-up).",
                ),
                picture=settling_svg(run),
                legend=SETTLING_LEGEND,
            ),
            Section(
                "Batch means",
                ("They should scatter around their mean without a trend, and one should say nothing of the next.",),
                picture=batches_svg(run),
                legend=BATCH_LEGEND,
            ),
            Section(
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


def _what(run: Any) -> str:
    noun = "1 replication" if run.replications == 1 else f"{run.replications} replications"
    return f"{noun} of {time_words(run.horizon_s)}, seed {run.seed}."


def _rows(run: Any) -> list[tuple[str, ...]]:
    return [_row(one) for one in run.series]


def _row(one: Any) -> tuple[str, ...]:
    found = one.batches
    if found is None:
        return (NAMES[one.name], ABSENT, "0", ABSENT, ABSENT, ABSENT, reasons(one))
    check = found.half_width_overlapping
    factor, unit = scale_of(one.unit, found.mean)
    return (
        NAMES[one.name],
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

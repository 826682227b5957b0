from dataclasses import replace

import numpy as np
import pytest

from opsim.report.numbers import time_words
from opsim.report.page import study_html
from opsim.report.studies.steady_state import answer, long_run_page
from opsim.study.long_run import batch_means, correlogram, flags, welch
from opsim.study.long_run.diagnostics import Flag
from opsim.study.long_run.steady_state import LongRun, LongSeries

H = 3600.0


def series(name, unit, values, *, by_job=False, raised=None, warm_up_s=0.0):
    found = batch_means(values)
    curve = np.empty(0) if by_job else values
    return LongSeries(
        name,
        unit,
        found,
        np.nan if by_job else found.batch_size * 0.2 * H,
        400.0 if by_job else np.nan,
        96 * H,
        tuple(flags(values) if raised is None else raised),
        correlogram(values, 20),
        values.size,
        curve,
        curve if by_job else welch(curve),
        warm_up_s,
    )


def long_run(variant="base", **flagged):
    rng = np.random.default_rng(1)
    made = (
        series("throughput_per_h", "1/h", rng.normal(54, 3, 480), raised=flagged.get("out", [])),
        series("time_in_system_s", "s", rng.normal(300, 30, 480), by_job=True, raised=flagged.get("stay", [])),
        series("work_in_progress", "jobs", rng.normal(4, 1, 480), raised=flagged.get("inside", [])),
    )
    return LongRun("Line", variant, 7, 1, 100 * H, 2 * H, 4 * H, "own", 0.2 * H, made, flagged.get("full", ()), False)


def test_a_run_that_is_well_is_told_with_its_batches_and_what_was_left_out():
    out, stay, inside, verdict = answer(long_run())
    assert out.startswith("Jobs finished: 5") and "± 0." in out and "per hour, from 40 batches of 2.4 h" in out
    assert out.endswith("after leaving out the first 4 h (the run's own warm-up).")
    assert (
        stay.startswith("Time in system: ") and "40 batches of 400 jobs" in stay and inside.startswith("Jobs inside: ")
    )
    assert verdict.startswith("Nothing speaks against it: no sign ") and "no test finds the start" in verdict


def test_growth_is_said_by_the_day_and_which_station_is_never_without_a_job():
    grows = [Flag("unstable", "", True, 12.4)]
    *_, inside, verdict = answer(long_run(inside=grows, full=("press",)))
    assert "(± not to be trusted)" in inside
    assert (
        verdict.startswith("Not believable yet: more comes than leaves") and "jobs inside (+3.10 jobs a day)" in verdict
    )
    assert "No longer run helps. Never without a job: press." in verdict


def test_growth_that_may_be_a_short_run_is_said_with_both_and_with_one_horizon():
    raised = [Flag("growing", "", True, 12.4), Flag("too_short", "", True, 3.0)]
    verdict = answer(long_run(inside=raised, full=("press",)))[-1]
    assert "within this run these keep growing: jobs inside (+3.10 jobs a day). Either more comes than" in verdict
    assert "Run 10 times as long: --horizon '970 h'." in verdict and "too short for jobs inside: " in verdict
    assert "No longer run helps" not in verdict and verdict.count("--horizon") == 1


def test_replications_that_are_each_too_short_are_called_so():
    made = long_run()
    short = batch_means(np.cumsum(np.random.default_rng(2).normal(size=(8, 60)), axis=1))
    stay = replace(made.series[1], batches=short, flags=(Flag("too_short", "", True, 3.0),))
    verdict = answer(replace(made, series=(made.series[0], stay, made.series[2])))[-1]
    assert "replications are independent, but each is too short to forget its start." in verdict


def test_a_short_run_is_told_how_long_it_should_be():
    verdict = answer(long_run(stay=[Flag("too_short", "", True, 3.0)]))[-1]
    assert "too short for time in system" in verdict and "About 3 times as long would do: --horizon '300 h'." in verdict


def test_small_doubts_are_told_as_such():
    cares = [
        Flag("start_left", "", False, 1.2),
        Flag("autocorrelated", "", False, 0.7),
        Flag("few_events", "", False, 57),
    ]
    verdict = answer(long_run(inside=cares))[-1]
    assert verdict.startswith(
        "Believe it with care: the second half is not as the first quarter in jobs inside (+1.20 jobs)"
    )
    assert "Only 57 jobs are counted." in verdict and "± is too narrow" in verdict
    unsettled = replace(long_run(), series=tuple(replace(one, warm_up_s=None) for one in long_run().series))
    assert "MSER-5 finds no warm-up to believe in jobs finished and jobs inside." in answer(unsettled)[-1]


def test_parts_of_days_are_never_believed():
    assert "ten whole days at least" in answer(replace(long_run(), part_of_days=True))[-1]


@pytest.mark.parametrize("seconds, words", [(45, "45 s"), (1800, "30 min"), (8640, "2.4 h"), (86400 * 12, "12 days")])
def test_times_are_said_with_two_digits(seconds, words):
    assert time_words(seconds) == words


def test_the_page_has_all_pictures_and_no_name_becomes_markup():
    page = study_html(long_run_page(long_run("<script>alert(1)</script>")))
    assert "<script" not in page and page.count("<svg") == 2 + 3 + 3 and ">nan" not in page
    assert page.index("Jobs finished: 5") < page.index("Figures of the steady state") < page.index("How it settles")

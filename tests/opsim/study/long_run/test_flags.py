from collections import Counter

import numpy as np
import pytest
from plans import loaded, queue

from opsim.log import CREATE, FINISH, QUEUE, STOCK, WORK, event_log, row
from opsim.results import Result
from opsim.study import run_scenario
from opsim.study.long_run import batch_means, flags
from opsim.study.long_run.steady_state import (
    DAY_S,
    FINE,
    WEEK_S,
    edges_of,
    jobs_in_a_row,
    look,
    people_at_work,
    sliced,
    waiting,
)
from tests.opsim.study.long_run.waits import autoregressions, mm1_waits


def codes(series, **how):
    return [flag.code for flag in flags(series, **how)]


def test_an_overloaded_queue_is_flagged_and_a_stable_one_is_not():
    """M/M/1 from empty, 20,000 customers, 50 seeds: load 1.1 always, 0.8 never; 0.8 is hardly ever flagged at all."""
    over = [codes(mm1_waits(1.1, 20_000, seed)) for seed in range(50)]
    stable = [codes(mm1_waits(0.8, 20_000, seed)) for seed in range(50)]
    assert all(found[0] == "growing" for found in over)
    assert not any("growing" in found for found in stable)
    assert sum(not found for found in stable) >= 42


def test_a_run_too_short_for_its_load_is_flagged_as_short_and_not_as_growing():
    found = [codes(mm1_waits(0.95, 20_000, seed)) for seed in range(50)]
    assert sum("too_short" in one for one in found) >= 45 and not any("growing" in one for one in found)


def test_growth_of_what_does_not_pile_up_is_a_start_that_shows():
    rising = np.linspace(1, 9, 1000) + np.random.default_rng(1).normal(0, 0.5, 1000)
    assert codes(rising)[0] == "growing" and "growing" not in codes(rising, piles_up=False)
    assert "start_left" in codes(rising, piles_up=False)


def test_a_start_that_is_left_in_is_seen():
    """AR(1) with 0.5 that begins 5 off and comes down over a tenth of the series; its rest alone is well."""
    made = autoregressions(0.5, 4000, 50, 2)
    biased = made + 5 * np.exp(-np.arange(4000) / 200)
    assert sum("start_left" in codes(one) for one in biased) >= 48
    assert sum("start_left" in codes(one[1600:]) for one in biased) <= 3


def test_each_flag_is_raised_by_luck_alone_in_a_few_of_hundred():
    counted = Counter(code for one in autoregressions(0.5, 4000, 300, 3) for code in codes(one))
    assert all(number <= 9 for number in counted.values()), counted


def test_few_jobs_and_a_warm_up_beyond_half_are_said():
    values = np.random.default_rng(4).normal(size=1000)
    assert codes(values, events=57) == ["few_events"] and codes(values, events=2000) == []
    (flag,) = flags(values, left_out=1500)
    assert flag.code == "too_short" and flag.serious and "more than half" in flag.says


def test_too_few_values_to_judge_are_said():
    assert codes(np.random.default_rng(5).normal(size=40)) == ["too_short"]


def short_queues(load, n, replications, how_many):
    """(how_many, replications, 0.9 n) waits from empty, the first tenth left out."""
    made = [mm1_waits(load, n, seed)[n // 10 :] for seed in range(how_many * replications)]
    return np.reshape(made, (how_many, replications, -1))


@pytest.mark.parametrize("load, n, replications, mean", [(0.9, 200, 5, 8.1), (0.95, 400, 10, 18.05)])
def test_replications_too_short_to_forget_their_start_are_flagged_though_they_are_independent(
    load, n, replications, mean
):
    """M/M/1 from empty, 100 times: many intervals miss theory, and hardly any goes without a flag."""
    clean, covered = 0, 0
    for rows in short_queues(load, n, replications, 100):
        found = batch_means(rows)
        clean += not flags(rows)
        covered += found.low <= mean <= found.high
    assert covered <= 70 and clean <= 8


def test_a_stable_queue_that_grows_within_its_run_is_called_short_too_and_never_unstable():
    """M/M/1 at load 0.95: many studies of ten short runs grow by luck."""
    found = [flags(rows) for rows in short_queues(0.95, 400, 10, 100)]
    growing = [{flag.code: flag for flag in one} for one in found if one and one[0].code == "growing"]
    assert len(growing) >= 30 and all("too_short" in one and "unstable" not in one for one in growing)
    assert all("either more comes than leaves, or the run is too short" in one["growing"].says for one in growing)


def test_no_longer_run_helps_is_only_said_where_something_else_shows_that_more_comes_than_leaves():
    over = mm1_waits(1.1, 20_000, 1)
    (flag,) = flags(over, overloaded=True)
    assert flag.code == "unstable" and "no longer run helps" in flag.says
    assert "no longer run helps" not in flags(over)[0].says
    assert codes(mm1_waits(0.8, 20_000, 2), overloaded=True) == codes(mm1_waits(0.8, 20_000, 2))


def test_long_replications_of_a_stable_queue_are_called_too_short_in_a_few_of_hundred():
    """Five of 20,000 customers at load 0.8."""
    found = [codes(rows) for rows in short_queues(0.8, 20_000, 5, 20)]
    assert sum("too_short" in one for one in found) <= 1 and not any("growing" in one for one in found)


def test_replications_of_a_few_values_show_nothing_of_their_start():
    (flag,) = flags(np.random.default_rng(6).normal(size=(20, 4)))
    assert flag.code == "too_short" and "4 values" in flag.says and flag.by == pytest.approx(2.5)


NAMES = dict.fromkeys(("worker", "station", "source", "product", "operation", "task"), ("a",))


def log_of(*rows, horizon_s=40.0):
    return event_log(sorted(rows, key=lambda one: one[2]), horizon_s, NAMES)


def test_what_waits_and_who_works_is_counted_by_hand():
    """A job waits from 0 to 10 and is worked on from 10 to 30; stock in a store waits for nothing."""
    log = log_of(
        row(QUEUE, 0, 10, job=0, station=0),
        row(QUEUE, 0, 40, job=1, station=0, cause=STOCK),
        row(WORK, 10, 30, worker=0, station=0, job=0),
    )
    edges_s = np.array([0.0, 20.0, 40.0])
    assert waiting(log, edges_s) == pytest.approx([0.5, 0]) and people_at_work(log, edges_s) == pytest.approx(
        [0.5, 0.5]
    )


def test_times_in_system_come_in_the_order_in_which_jobs_finish():
    log = log_of(
        *(row(CREATE, at, at, job=job) for job, at in enumerate((0, 1, 2))),
        *(row(FINISH, at, at, job=job) for job, at in ((1, 5), (0, 7), (2, 30))),
    )
    found = sliced(log, np.array([0.0, 40.0]))
    assert found.stay_s.tolist() == [4, 7, 28] and found.finish_s.tolist() == [5, 7, 30] and found.jobs == 3


def test_jobs_of_replications_become_groups_of_equal_number_and_the_first_are_left_over():
    logs = [
        log_of(
            *(row(CREATE, at, at, job=at) for at in range(n)),
            *(row(FINISH, at + 1 + at % 2, at + 1 + at % 2, job=at) for at in range(n)),
            horizon_s=100.0,
        )
        for n in (20, 31)
    ]
    rows = jobs_in_a_row([sliced(log, np.array([0.0, 100.0])) for log in logs], 0.0, 10)
    assert rows.shape == (2, 10) and rows.mean() == pytest.approx(1.5, abs=0.05)
    assert jobs_in_a_row([sliced(logs[0], np.array([0.0, 100.0]))], 15.0, 10) is None


def test_slices_are_whole_weeks_or_days_where_the_floor_keeps_hours_and_the_run_is_long():
    assert edges_of(30 * DAY_S + 5, True)[-1] == 30 * DAY_S and edges_of(30 * DAY_S, True)[1] == DAY_S
    assert edges_of(10 * WEEK_S, True)[1] == WEEK_S
    assert edges_of(3 * DAY_S, True).size == edges_of(30 * DAY_S, False).size == FINE + 1


@pytest.fixture(scope="module")
def stable(tmp_path_factory):
    """M/M/1 at load 1/2: L = 1 job, W = 2 s (one is served in 1 s)."""
    text = queue(horizon="12000 s", warm_up="200 s", every="2 s").replace("seed: 1", "seed: 3, replications: 1")
    return run_scenario(loaded(text), folder=tmp_path_factory.mktemp("stable"), processes=1)


def test_a_stable_queue_is_believed_and_its_intervals_hold_theory(stable):
    run = look(stable)
    found = {one.name: one for one in run.series}
    assert not run.serious and run.left_out_s >= 200 and not run.part_of_days and run.full_stations == ()
    for name, truth in (("throughput_per_h", 1800), ("time_in_system_s", 2.0), ("work_in_progress", 1.0)):
        assert found[name].batches.low <= truth <= found[name].batches.high, name
    assert found["work_in_progress"].curve.size == FINE and found["time_in_system_s"].curve.size == 0


def test_what_is_left_out_may_be_asked_for(stable):
    run = look(stable, 3000.0)
    assert (run.left_out_s, run.why) == (3000.0, "asked")
    with pytest.raises(ValueError, match="nothing is left"):
        look(stable, 12000.0)


def test_a_floor_to_which_more_comes_than_leaves_is_not_believed(tmp_path):
    text = queue(horizon="6000 s", warm_up="100 s", every="0.9 s").replace("seed: 1", "seed: 3, replications: 1")
    run = look(run_scenario(loaded(text), folder=tmp_path, processes=1))
    flagged = {one.name: [flag.code for flag in one.flags] for one in run.series}
    assert run.serious and "unstable" in flagged["work_in_progress"] and "unstable" in flagged["time_in_system_s"]
    assert "unstable" not in flagged["throughput_per_h"] and run.full_stations and run.nobody_free


def test_a_stable_floor_that_grows_within_a_short_run_is_not_called_overloaded(tmp_path):
    """M/M/1 at load 0.95, ten runs of 480 services: most grow, and only a longer run tells why."""
    text = queue(horizon="480 s", warm_up="0 s", every="1.0526 s").replace("seed: 1", "seed: 3, replications: 10")
    run = look(run_scenario(loaded(text), folder=tmp_path, processes=1))
    flagged = {flag.code for one in run.series for flag in one.flags}
    assert run.serious and "too_short" in flagged and "unstable" not in flagged
    assert run.full_stations == () and not run.nobody_free


def test_results_without_rows_are_refused(stable, tmp_path):
    with pytest.raises(ValueError, match="no events here"):
        look(Result(tmp_path, stable.summary))

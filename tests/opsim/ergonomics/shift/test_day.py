"""All that bodies did, frame by frame: times that add up, postures that are looked at once."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from plans import plan, ran

from opsim.ergonomics.angles import AT, COLUMNS
from opsim.ergonomics.options import Options
from opsim.ergonomics.shift import day as seen
from opsim.ergonomics.shift.day import days, hours_s
from opsim.ergonomics.shift.frames import STANDING, WAITING, WALKING
from opsim.ergonomics.trunk import trunk_exposure
from opsim.log import BREAK, SETUP, WAIT, WALK, WORK
from opsim.subjects.exposure.plan import Handling
from opsim.subjects.tools.plan import Moment
from tests.opsim.ergonomics.made_work import BEND, COUNT, Bending, Bends, made_plan
from tests.opsim.kpi.made_logs import made, row, work
from tests.opsim.made_walks import Walk, walking

HOUR_S = 3600.0
SHIFT = """
opsim: 1
name: a shift
run: {start: Mon 05:40, horizon: 50 min, warm_up: 7 min, seed: 6}
layout: {places: {here: [0 m, 0 m], there: [6 m, 0 m]}}
libraries: {bench: libraries/bench_work.npz}
shifts: {day: {from: 05:40, to: 08:10, at_break: resume, breaks: {BREAKS}}}
tasks:
  stoop: {emulator: bench/stoop}
  carry: {emulator: bench/carry, team: 2}
  label: {dist: lognormal, mean: 6 s, cv: 0.3}
stations:
  a: {at: here, tasks: [stoop, label], buffer: 1}
  b: {at: there, tasks: [carry], buffer: 2}
products: {p: {share: 0.5, route: [a, b]}, q: {share: 0.5, route: [a]}}
release: {kind: saturated}
workers:
  ana: {shift: day, skills: {a: 1.0, b: 1.0}}
  ben: {skills: {a: 0.8, b: 1.2}}
"""
BREAKS = ", ".join(f"b{i}: {{at: 06:{4 * i + 1:02d}, lasts: 1 min}}" for i in range(14))
SHIFT = SHIFT.replace("BREAKS", BREAKS)


def bend(start, end, *, worker=0, k=0, progress=(0.0, 1.0), task=BEND):
    return work(start, end, 0, worker=worker, k=k, progress=progress, task=task)


def frames_of(rows, of=None):
    """All frames of worker 0, put together."""
    of = made_plan() if of is None else of
    found = [frames for frames in days(made(rows, of), of) if frames.worker == 0]
    return {
        name: np.concatenate([getattr(frames, name) for frames in found])
        for name in ("start_s", "seconds", "task", "k", "row", "progress", "carrying", "repeated", "static", "measures")
    }


def flexion(found):
    return found["measures"][:, AT["trunk_flexion"]]


@pytest.fixture(
    scope="module", params=["", "human: {fatigue: {model: lffrm, tires_half_in: 1 h}}"], ids=["fresh", "tired"]
)
def shift(request):
    """Log and plan of a shift with breaks in the middle of work, a team, and walks that nobody draws; and tired."""
    return ran(SHIFT + request.param)


# Known answers


def test_who_bends_evenly_to_90_degrees_and_back_has_a_frame_for_every_twelfth_of_a_second():
    found = frames_of([bend(0, 9)])
    assert found["seconds"].tolist() == pytest.approx([1 / 12] * 108)
    assert found["start_s"].tolist() == pytest.approx((np.arange(108) / 12).tolist())
    middle_s = (np.arange(108) + 0.5) / 12
    assert flexion(found) == pytest.approx(90 * (1 - np.abs(2 * middle_s / 9 - 1)), abs=1e-4)
    assert found["progress"] == pytest.approx(middle_s / 9)


def test_who_takes_half_the_time_passes_the_same_postures_in_frames_half_as_long():
    slow, quick = frames_of([bend(0, 9)]), frames_of([bend(0, 4.5)])
    assert np.array_equal(slow["measures"], quick["measures"], equal_nan=True)
    assert np.allclose(quick["seconds"], slow["seconds"] / 2)


def test_a_time_without_a_body_is_one_frame_of_which_nothing_is_known():
    found = frames_of([bend(0, 5, task=COUNT)])
    assert found["seconds"].tolist() == [5] and np.isnan(found["measures"]).all() and found["k"].tolist() == [0]


def test_postures_that_are_not_numbers_are_not_known_and_their_time_is_still_there():
    class Lost(Bends):
        def positions_m(self, n_times):
            found = super().positions_m(n_times)
            found[:, : n_times // 3] = np.nan
            return found

    found = frames_of([bend(0, 9)], made_plan(Bending(kind=Lost)))
    unknown = np.isnan(found["measures"]).all(axis=1)
    assert found["seconds"].sum() == pytest.approx(9) and found["seconds"][unknown].sum() == pytest.approx(3, abs=0.1)


def test_no_frame_crosses_an_hour_of_the_clock():
    of = made_plan(start_s=6 * HOUR_S + 1800.0)
    found = frames_of([bend(1795.5, 1804.5), bend(1804.5, 1900, k=0, task=COUNT)], of)
    assert not np.any((found["start_s"] < 1800 - 1e-9) & (found["start_s"] + found["seconds"] > 1800 + 1e-9))
    assert found["seconds"].sum() == pytest.approx(1900 - 1795.5)
    assert flexion(found)[53:55] == pytest.approx([89.17, 89.17], abs=0.01)


def test_hours_of_the_clock_cut_the_window():
    of = made_plan(start_s=1800.0, warm_up_s=600.0, horizon_s=2 * HOUR_S)
    assert hours_s(of) == [600, 1800, 5400, 7200]
    assert hours_s(replace(of, start_s=0.0)) == [600, 3600, 7200]


def test_only_what_lies_in_the_window_is_there():
    found = frames_of([bend(0, 9), bend(17, 26, k=1)], made_plan(warm_up_s=4.5, horizon_s=20.0))
    assert found["seconds"].sum() == pytest.approx(4.5 + 3) and found["start_s"].min() == 4.5
    assert flexion(found)[:54] == pytest.approx(90 * (1 - (np.arange(54) + 0.5) / 54), abs=1e-3)


def test_hands_are_full_between_their_moments():
    handling = Handling(load_kg=8.0, start=Moment(share=0.25), end=Moment(share=0.5))
    of = made_plan()
    of = replace(of, tasks=(replace(of.tasks[BEND], handling=handling), *of.tasks[1:]))
    found = frames_of([bend(0, 9)], of)
    assert np.array_equal(found["carrying"], (found["progress"] >= 0.25) & (found["progress"] < 0.5))


def test_who_begins_the_same_four_times_a_minute_repeats():
    often, seldom = ([bend(every * k, every * k + 9, k=k) for k in range(4)] for every in (15, 20.1))
    assert frames_of(often)["repeated"].all() and not frames_of(seldom)["repeated"].any()


def test_who_stays_bent_for_longer_than_a_minute_is_static_also_over_an_hour_of_the_clock():
    class Stays(Bending):
        def sample(self, n, rng, **how):
            drawn = super().sample(n, rng, **how)
            return Still(drawn.duration_s, drawn.depth_deg, drawn.skeleton)

    of = made_plan(Stays((50.0,) * 64), horizon_s=2 * HOUR_S)
    found = frames_of([bend(HOUR_S - 40, HOUR_S + 40)], of)
    assert found["static"].all()
    assert not frames_of([bend(HOUR_S - 40, HOUR_S + 15)], of)["static"].any()


class Still(type(Bending().sample(1, None))):
    """Bent as far all the time."""

    course = staticmethod(lambda share: np.full(np.shape(share), 90.0))


def test_waiting_gives_no_frames_unless_people_are_said_to_stand_upright():
    rows = [bend(0, 9), row(WAIT, 9, 30, worker=0), row(BREAK, 30, 60, worker=0)]
    assert frames_of(rows)["seconds"].sum() == pytest.approx(9)
    found = frames_of(rows, made_plan(ergonomics=Options(waiting="upright")))
    waits = found["task"] == WAITING
    assert found["seconds"][waits].tolist() == [21] and not found["carrying"][waits].any()
    assert np.array_equal(found["measures"][waits][0], STANDING, equal_nan=True)


def test_a_worker_s_frames_come_before_the_next_one_s():
    of = made_plan(horizon_s=3 * HOUR_S)
    rows = [bend(at, at + 9, worker=worker, k=k) for worker in (0, 1) for k, at in enumerate((0, 4000, 9000))]
    assert [frames.worker for frames in days(made(rows, of), of)] == [0, 0, 0, 1, 1, 1]


# Walking


def test_walks_have_the_postures_of_their_own_or_of_one_of_about_their_length():
    of = walking(replace(made_plan(), distance_m=((0.0, 6.0), (6.0, 0.0)), places=("a", "b")), Walk(lean_deg=30.0))
    rows = [row(WALK, 10 * i, 10 * i + 5, worker=0, places=(0, 1)) for i in range(40)]
    found = frames_of([*rows, bend(500, 509)], of)
    walked = found["task"] == WALKING
    assert found["seconds"][walked].sum() == pytest.approx(40 * 5)
    assert found["k"][walked].max() == 39 and not found["carrying"][walked].any()
    leans = {round(float(lean), 2) for lean in flexion(found)[walked]}
    assert len(leans) == 16 and 20 < min(leans) < max(leans) < 40


def test_a_walk_that_cannot_be_drawn_is_not_known():
    of = walking(replace(made_plan(), distance_m=((0.0, 0.2), (0.2, 0.0)), places=("a", "b")))
    found = frames_of([row(WALK, 0, 0.2, worker=0, places=(0, 1))], of)
    assert found["task"].tolist() == [WALKING] and np.isnan(found["measures"]).all()


# Laws


def test_the_seconds_of_all_frames_are_the_time_at_work_of_each_worker(shift):
    log, of = shift
    inside_s = log.clipped_s(*of.window_s)
    worked = np.isin(log["kind"], (WORK, SETUP)) & (log["worker"] >= 0) & (log["task"] >= 0)
    for rank in range(len(of.workers)):
        frames_s = sum(frames.seconds.sum() for frames in days(log, of) if frames.worker == rank)
        assert frames_s == pytest.approx(inside_s[worked & (log["worker"] == rank)].sum(), rel=1e-12)


def test_the_seconds_of_a_row_are_its_frames(shift):
    log, of = shift
    spent_s = np.zeros(len(log))
    for frames in days(log, of):
        np.add.at(spent_s, frames.row, frames.seconds)
        assert np.array_equal(frames.task, log["task"][frames.row]) and np.array_equal(frames.k, log["k"][frames.row])
    worked = np.isin(log["kind"], (WORK, SETUP)) & (log["worker"] >= 0)
    assert np.allclose(spent_s, np.where(worked, log.clipped_s(*of.window_s), 0), rtol=0, atol=1e-9)


def test_frames_follow_each_other_and_do_not_overlap(shift):
    log, of = shift
    for frames in days(log, of):
        assert np.all(frames.start_s[1:] >= frames.end_s[:-1] - 1e-9)
        hours = np.floor((of.start_s + np.r_[frames.start_s, frames.end_s - 1e-9]) / HOUR_S)
        assert np.unique(hours).size == 1


def test_time_bent_is_as_the_exposure_of_trunks_finds_it(shift):
    log, of = shift
    found = trunk_exposure(log, of)
    for rank in range(len(of.workers)):
        own = [frames for frames in days(log, of) if frames.worker == rank]
        bent = [frames.seconds[frames.measures[:, AT["trunk_flexion"]] >= 20].sum() for frames in own]
        assert sum(bent) == pytest.approx(found.beyond_s(20)[rank], rel=0.01)
        unknown_s = sum(frames.seconds[~frames.known].sum() for frames in own)
        assert unknown_s == pytest.approx(found.unmeasured_s[rank])


def test_each_performance_is_looked_at_once(shift, monkeypatch):
    """Breaks and the hours of the clock cut performances."""
    log, of = shift
    looked = []
    real = seen.measures_of

    def counted(block, rows, options, neutral_rad):
        looked.extend((id(block.scores), float(block.duration_s[at])) for at in rows)
        return real(block, rows, options, neutral_rad)

    monkeypatch.setattr(seen, "measures_of", counted)
    assert sum(len(frames) for frames in days(log, of)) > 12 * 60
    emulated = [rank for rank, task in enumerate(of.tasks) if task.name != "label"]
    rows = np.isin(log["task"], emulated) & (log["worker"] >= 0) & (log.clipped_s(*of.window_s) > 0)
    pieces = sum(np.count_nonzero(rows & (log.clipped_s(*edges_s) > 0)) for edges_s in pairwise(hours_s(of)))
    performed = set(zip(*(log[name][rows].tolist() for name in ("worker", "task", "k"))))
    assert len(looked) == len(performed) <= pieces


@pytest.mark.parametrize("cuts", [(0.5,), (0.1, 0.4, 0.8)])
def test_pieces_are_the_whole(cuts):
    whole = frames_of([bend(0, 9)])
    rows = [bend(100 * i + 9 * a, 100 * i + 9 * b, progress=(a, b)) for i, (a, b) in enumerate(pairwise([0, *cuts, 1]))]
    parts = frames_of(rows)
    degrees = np.arange(0, 91, 10)
    by_degree = [np.histogram(flexion(found), degrees, weights=found["seconds"])[0] for found in (whole, parts)]
    assert by_degree[0] == pytest.approx(by_degree[1], abs=1e-6)


def test_nobody_s_frames_depend_on_who_else_works(shift):
    log, of = shift
    ana = [frames for frames in days(log, of) if frames.worker == 0]
    alone = log.where((log["worker"] == 0) | (log["worker"] < 0))
    for one, other in zip(ana, days(alone, of), strict=False):
        assert np.array_equal(one.measures, other.measures, equal_nan=True)
        assert np.array_equal(one.seconds, other.seconds)


def test_a_plan_without_workers_has_no_frames():
    of = plan(SHIFT)
    assert not list(days(made([], replace(of, workers=())), replace(of, workers=())))
    assert not list(days(made([], of), of)) and len(COLUMNS) == len(STANDING)


def test_a_load_without_a_body_is_in_the_hands_for_its_share_of_each_piece():
    """A count of 5 s, loaded from 0.2 to 0.6: in pieces of 4 s (to 0.8) and 1 s."""
    plan = made_plan()
    loaded = replace(plan.tasks[COUNT], handling=Handling(3.0, start=Moment(share=0.2), end=Moment(share=0.6)))
    plan = replace(plan, tasks=tuple(loaded if at == COUNT else task for at, task in enumerate(plan.tasks)))
    pieces = [bend(0, 4, task=COUNT, progress=(0.0, 0.8)), bend(10, 11, task=COUNT, progress=(0.8, 1.0))]
    found = frames_of(pieces, plan)
    assert found["seconds"].tolist() == pytest.approx([1, 2, 1, 1])
    assert found["carrying"].tolist() == [False, True, False, False]
    assert found["start_s"].tolist() == pytest.approx([0, 1, 3, 10])
    assert np.isnan(found["measures"]).all()

"""Frames booked into a ledger: the sums of a plain loop, whatever stretches they came in.

Each frame is scored with what the scenario says of its own task.

How fast bodies gather dose: against many draws, by task and by worker.
"""

from collections import defaultdict
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import plans
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from plans import ran

from opsim.ergonomics.angles import AT, COLUMNS
from opsim.ergonomics.measures import measures_of_positions
from opsim.ergonomics.scores.scoring import NOTHING_OPEN, WALKING, bounds_of, score
from opsim.ergonomics.shift import worst as dose_rates
from opsim.ergonomics.shift.day import days, fold, said_of, scored
from opsim.ergonomics.shift.frames import STANDING, WAITING, Frames
from opsim.ergonomics.shift.frames import WALKING as WALKS
from opsim.ergonomics.shift.ledger import BINS, KEY, Booking
from opsim.ergonomics.shift.worst import DoseRates, WorstSeen, clock_of, dose_rates_of, worst_frames
from opsim.subjects.exposure.plan import Handling
from tests.opsim.ergonomics.made_work import BEND, COUNT, Bending, Bends, made_plan
from tests.opsim.kpi.made_logs import made, work

HOUR_S = 3600.0


def frames(worker, start_s, seconds, station, task, product, trunk, arms, row=None):
    """N frames; arms (N, 2) degrees of elevation, left and right."""
    n = len(seconds)
    measures = np.full((n, len(COLUMNS)), np.nan, np.float32)
    measures[:, AT["trunk_flexion"]] = trunk
    measures[:, [AT["left_arm_elevation"], AT["right_arm_elevation"]]] = arms
    none = np.zeros(n, bool)
    ranks = (np.asarray(column, np.int32) for column in (station, task, product))
    row = np.arange(n) if row is None else np.asarray(row)
    times = np.asarray(start_s, float), np.asarray(seconds, float)
    return Frames(worker, *times, *ranks, row, np.zeros(n, int), np.zeros(n), none, none, none, measures)


def scores(rula, reba, owas):
    """Each (N, 2)."""
    return SimpleNamespace(**{k: np.asarray(v, np.int8) for k, v in {"rula": rula, "reba": reba, "owas": owas}.items()})


def naive(stretches, start_s):
    """The definition: (name, bin or None where not known) -> seconds, of each key, frame after frame."""
    found = defaultdict(float)
    for some, of in stretches:
        for i in range(len(some)):
            hour = int((start_s + some.start_s[i]) // HOUR_S) % 24
            key = (some.worker, int(some.station[i]), int(some.task[i]), int(some.product[i]), hour)
            for name in ("rula", "reba", "owas"):
                for bound, ending in ((0, ""), (1, "_at_most")):
                    found[key, name + ending, int(getattr(of, name)[i][bound]) or None] += some.seconds[i]
            found[key, "trunk", _degree(some.measures[i, AT["trunk_flexion"]])] += some.seconds[i]
            arms = [some.measures[i, AT[f"{side}_arm_elevation"]] for side in ("left", "right")]
            known = [arm for arm in arms if not np.isnan(arm)]
            found[key, "arm", _degree(max(known)) if known else None] += some.seconds[i]
    return {of: seconds for of, seconds in found.items() if seconds}


def _degree(angle):
    return None if np.isnan(angle) else int(np.floor(angle))


def told(ledger):
    """The same of a ledger."""
    found = {}
    for at, key in enumerate(ledger.key.tolist()):
        for name, bins in ledger.bins.items():
            for column in np.flatnonzero(bins[at]).tolist():
                found[tuple(key), name, BINS[name].first + column - 1 if column else None] = float(bins[at, column])
    return found


EIGHTHS = st.integers(1, 200).map(lambda n: n / 8)
ANGLE = st.one_of(st.just(float("nan")), st.integers(-179, 178).map(lambda n: n + 0.25))
ARM = st.one_of(st.just(float("nan")), st.integers(0, 179).map(lambda n: n + 0.5))
PAIR = st.integers(0, 4).flatmap(lambda low: st.tuples(st.just(low), st.integers(low, 4) if low else st.just(0)))
ONE = st.tuples(EIGHTHS, *(st.integers(-1, 2),) * 3, ANGLE, ARM, ARM, PAIR, PAIR, PAIR, st.booleans())


@st.composite
def stretch(draw):
    """Frames within an hour of the clock, seconds whole eighths, so that every sum is exact."""
    drawn = draw(st.lists(ONE, min_size=1, max_size=20))
    seconds, station, task, product, trunk, left, right, rula, reba, owas, same = zip(*drawn)
    row = np.cumsum(~np.array(same))
    first = np.searchsorted(row, row)
    station, task, product = (np.array(column)[first] for column in (station, task, product))
    start_s = draw(st.integers(0, 40)) * HOUR_S + np.cumsum(seconds) / 8
    arms = np.stack([left, right], axis=1)
    some = frames(draw(st.integers(0, 2)), start_s, seconds, station, task, product, trunk, arms, row)
    return some, scores(rula, reba, owas)


@settings(max_examples=40, deadline=None)
@given(st.lists(stretch(), max_size=6))
def test_the_ledger_is_the_plain_loop_to_the_last_bit(stretches):
    booking = Booking(start_s=5 * HOUR_S)
    for some, of in stretches:
        booking.add(some, of)
    assert told(booking.close()) == naive(stretches, 5 * HOUR_S)


def by_hand():
    booking = Booking(start_s=23 * HOUR_S)
    known = [[3, 5], [6, 7], [7, 7]]
    first = frames(0, [0, 10, 30], [10, 20, 5], [0, 0, 1], [0, 0, 2], [0, 0, 0], [10, 65, np.nan], [[5, 61]] * 3)
    booking.add(first, scores(known, [[1, 1], [8, 9], [0, 0]], [[1, 3]] * 3))
    late = frames(1, [HOUR_S], [100], [-1], [WAITING], [-1], [np.nan], [[np.nan, np.nan]])
    booking.add(late, scores([[0, 0]], [[0, 0]], [[0, 0]]))
    return booking.close()


def test_seconds_from_a_score_or_an_angle_on_are_what_the_hand_finds():
    ledger = by_hand()
    assert ledger.key.tolist() == [[0, 0, 0, 0, 23], [0, 1, 2, 0, 23], [1, -1, WAITING, -1, 0]]
    assert ledger.seconds.tolist() == [30, 5, 100] and ledger.unmeasured_s.tolist() == [0, 0, 100]
    assert ledger.from_s("rula", 5).tolist() == [20, 5, 0] and ledger.from_s("rula_at_most", 5).tolist() == [30, 5, 0]
    assert ledger.from_s("reba", 8).tolist() == [20, 0, 0] and ledger.from_s("owas_at_most", 3).tolist() == [30, 5, 0]
    assert ledger.from_s("trunk", 60).tolist() == [20, 0, 0] and ledger.from_s("arm", 60).tolist() == [30, 5, 0]
    assert ledger.score_seconds("rula").tolist() == [3 * 10 + 6 * 20, 7 * 5, 0]


@pytest.mark.parametrize("column", KEY)
def test_cells_put_together_by_any_column_sum_to_all(column):
    ledger = by_hand()
    values = np.unique(ledger.key[:, KEY.index(column)])
    by, all_of = ledger.by(column, values), ledger.together()
    for name, bins in by.bins.items():
        assert np.array_equal(bins.sum(axis=0), all_of.bins[name][0])
    assert ledger.by(column, np.array([77])).seconds.tolist() == [0]


def test_an_empty_ledger_has_no_time():
    ledger = Booking().close()
    assert ledger.seconds.shape == (0,) and ledger.together().seconds.tolist() == [0]
    assert ledger.by("worker", np.arange(2)).from_s("rula", 5).tolist() == [0, 0]


HEAVY = Handling(load_kg=25.0, force="static", grip="poor", forearm="mid", arms_supported=False, sitting=False)
SAID = replace(HEAVY, legs="balanced", rapid=False)


def plan():
    of = made_plan()
    return replace(of, tasks=(replace(of.tasks[BEND], handling=SAID), *of.tasks[1:]))


def scored_frames(tasks, flexion, **flags):
    n = len(tasks)
    measures = np.tile(STANDING, (n, 1))
    measures[:, AT["trunk_flexion"]] = flexion
    measures[np.isnan(flexion)] = np.nan
    marks = {name: np.asarray(flags.get(name, np.zeros(n)), bool) for name in ("carrying", "repeated", "static")}
    whole, ranks = np.arange(n), np.asarray(tasks, np.int32)
    return Frames(
        0, whole * 1.0, np.ones(n), ranks, ranks, ranks, whole, whole, whole * 0.1, **marks, measures=measures
    )


def test_each_task_s_frames_are_scored_by_what_is_said_of_it_whatever_stands_between():
    tasks = [BEND, COUNT, WALKS, BEND, WAITING, COUNT]
    some = scored_frames(tasks, [70.0, 70, 10, 30, 0, 10], carrying=[1, 1, 1, 0, 0, 1], repeated=[1, 0, 0, 0, 0, 0])
    found, of = scored(some, plan()), plan()
    for at, task in enumerate(tasks):
        flags = (some.repeated[at], some.static[at], some.carrying[at])
        alone = score(some.measures[at : at + 1], said_of(task, of), of.ergonomics, *flags)
        for name in ("rula", "reba", "owas"):
            assert np.array_equal(getattr(found, name)[at], getattr(alone, name)[0])


def test_what_nobody_knows_scores_nothing():
    found = scored(scored_frames([BEND, COUNT], [np.nan, 5.0]), plan())
    assert not found.rula[0].any() and not found.reba[0].any() and not found.owas[0].any() and found.rula[1].all()


def test_a_load_that_is_said_leaves_nothing_open_and_one_that_is_not_does():
    found = scored(scored_frames([BEND, COUNT], [70.0, 70.0], carrying=[1, 1]), plan())
    assert found.rula[0, 0] == found.rula[0, 1] and found.rula[1, 0] < found.rula[1, 1]


def test_who_waits_stands_and_who_walks_walks():
    of = plan()
    assert said_of(WAITING, of) == NOTHING_OPEN and said_of(BEND, of) == bounds_of(SAID)
    assert said_of(WALKS, of).empty_handed() == WALKING.empty_handed()


def test_every_fold_sees_the_same_stretches_once():
    class Seen:
        def __init__(self):
            self.stretches = []

        def add(self, scored_frames, scores):
            self.stretches.append((scored_frames.worker, len(scored_frames), len(scores.rula)))

    of, folds = made_plan(horizon_s=7200.0), [Seen(), Seen()]
    rows = [work(at, at + 9, 0, worker=worker, k=at // 3600, task=BEND) for worker in (0, 1) for at in (0, 3600)]
    fold(made(rows, of), of, folds)
    assert folds[0].stretches == folds[1].stretches == [(w, 108, 108) for w in (0, 0, 1, 1)]


@pytest.mark.parametrize("name", ["rula", "reba", "owas"])
def test_somebody_who_stands_upright_is_at_the_least(name):
    """RULA 2 and not 1, as a straight elbow is a lower arm of 2."""
    found = scored(scored_frames([WAITING], [0.0]), plan())
    assert getattr(found, name)[0].tolist() == [2 if name == "rula" else 1] * 2 and len(STANDING) == len(COLUMNS)


CELL = """
opsim: 1
name: cell
run: {start: Mon 06:30, horizon: 12 min, warm_up: 1 min, seed: 3}
layout: {places: {here: [0 m, 0 m]}}
libraries: {bench: libraries/bench_work.npz}
tasks: {stoop: {emulator: bench/stoop, load: 12 kg}, place: {emulator: bench/place}, label: {fixed: 4 s}}
stations: {low: {at: here, tasks: [stoop, place, label], servers: 2, buffer: 2}}
products: {p: {route: [low]}}
release: {kind: saturated}
workers: {ana: {skills: {low: 1.0}}, ben: {skills: {low: 0.8}}}
"""


@pytest.fixture(scope="module")
def cell():
    log, plan = ran(CELL)
    return log, plan, worst_frames(log, plan, 10)


def test_who_bends_deepest_in_the_middle_is_worst_there():
    plan = made_plan(Bending((30.0, 80.0, 50.0) + (0.0,) * 61, kind=Bends), start_s=6 * 3600.0)
    plan = replace(plan, tasks=(replace(plan.tasks[BEND], handling=Handling(load_kg=12.0)), *plan.tasks[1:]))
    rows = [work(100 * k, 100 * k + 9, 0, worker=0, k=k, task=BEND) for k in range(3)]
    (found,) = worst_frames(made([*rows, work(400, 405, 0, worker=1, k=0, task=COUNT)], plan), plan, 5)
    assert (found.worker, found.task, found.station, found.product, found.k) == ("ana", "bend", "s1", "p", 1)
    assert found.progress == pytest.approx(0.5, abs=0.01) and found.clock == "Mon 06:01:44"
    assert found.measures[AT["trunk_flexion"]] == pytest.approx(80, abs=1) and found.load_kg == 12
    head = found.joints_m[found.skeleton.names.index("head")] - found.joints_m[0]
    assert np.rad2deg(np.arctan2(head[0], head[2])) == pytest.approx(80, abs=1)


def test_nobody_has_two_of_one_task_and_the_worst_come_first(cell):
    *_, found = cell
    assert {(one.worker, one.task) for one in found} == {(w, t) for w in ("ana", "ben") for t in ("stoop", "place")}
    assert len(found) == 4 and [one.rula for one in found] == sorted((one.rula for one in found), reverse=True)
    (first,) = worst_frames(*cell[:2], 1)
    assert (first.worker, first.task, first.at_s) == (found[0].worker, found[0].task, found[0].at_s)


def test_a_list_of_them_reads_in_a_line_each_without_arrays(cell):
    first = cell[2][0]
    assert repr(first).startswith(f"<Worst: {first.worker} at {first.task}, {first.clock}: RULA {first.rula[0]}")
    assert "REBA" in repr(first) and len(repr(first)) < 100 and str(first) == repr(first)


def test_of_each_task_there_may_be_the_worst_alone(cell):
    log, plan, found = cell
    seen = WorstSeen()
    fold(log, plan, [seen])
    alone = [(one.worker, one.task) for one in seen.worst(log, plan, 10, one_a_task=True)]
    first = {one.task: (one.worker, one.task) for one in reversed(found)}
    assert len(alone) == 2 and set(alone) == set(first.values())


def test_no_frame_of_the_worker_at_the_task_is_worse_and_its_time_is_counted(cell):
    log, plan, found = cell
    for one in found:
        rank, task = [w.name for w in plan.workers].index(one.worker), [t.name for t in plan.tasks].index(one.task)
        least, spent_s = 0, 0.0
        for frames in days(log, plan):
            if frames.worker == rank:
                rula = np.where(frames.task == task, scored(frames, plan).rula[:, 0], 0)
                least, spent_s = max(least, int(rula.max())), spent_s + frames.seconds[rula >= one.rula[0]].sum()
        assert least == one.rula[0] and one.seconds == pytest.approx(spent_s)


def test_the_joints_are_those_that_were_measured_and_the_reasons_those_of_the_score(cell):
    _, plan, found = cell
    for one in found:
        again = measures_of_positions(one.joints_m, one.skeleton.names, plan.ergonomics)
        same = [AT[name] for name in ("trunk_flexion", "left_arm_elevation", "right_elbow", "left_hand_up_m")]
        assert np.allclose(again[same], one.measures[same], atol=1e-3)
        assert tuple(one.why["rula"]["score"]) == one.rula and tuple(one.why["reba"]["score"]) == one.reba


def test_clocks_of_long_runs_go_on_to_the_next_day(cell):
    assert clock_of(cell[1], 0) == "Mon 06:30" and clock_of(cell[1], 20 * 3600 + 61) == "Tue 02:31:01"


def test_one_a_task_keeps_the_worst_of_each_in_their_order(cell):
    log, plan, found = cell
    seen = WorstSeen()
    fold(log, plan, [seen])
    kept = seen.worst(log, plan, 10, one_a_task=True)
    first = {one.task: one.row for one in reversed(found)}
    assert [one.row for one in kept] == [one.row for one in found if first[one.task] == one.row] and len(kept) == 2


DOSE_RATES_CELL = """
opsim: 1
name: doses
run: {horizon: 1 h, seed: 3}
libraries: {bench: libraries/bench_work.npz}
layout: {places: {a: [0 m, 0 m]}}
tasks:
  bend: {emulator: bench/stoop, load: 8 kg}
  look: {emulator: bench/inspect, load: 0 kg}
  wait: {fixed: 5 s}
  bake: {fixed: 9 s, automatic: true}
stations: {s: {at: a, tasks: [bend, look, wait, bake]}}
products: {p: {route: [s]}}
release: {kind: poisson, every: 50 s}
workers: {ana: {skills: {s: 1}}, ben: {skills: {s: 1}}}
"""
BAKE, DOSE_RATES_BEND, LOOK, WAIT = range(4)


@pytest.fixture(scope="module")
def dose_rates_plan():
    return plans.plan(DOSE_RATES_CELL)


@pytest.fixture
def rates(dose_rates_plan):
    return DoseRates(dose_rates_plan, 0)


def test_a_stoop_weighs_more_than_a_look_and_what_nobody_has_seen_weighs_nothing(rates):
    bend, look = rates.per_s(0, DOSE_RATES_BEND), rates.per_s(0, LOOK)
    assert 1 <= look < 3 < bend <= 7
    assert rates.per_s(0, WAIT) == rates.per_s(0, BAKE) == 0.0


def test_a_few_draws_stand_within_a_tenth_of_many(dose_rates_plan, rates, monkeypatch):
    monkeypatch.setattr(dose_rates, "N_DRAWS", 256)
    many = DoseRates(dose_rates_plan, 0)
    for worker, task in ((0, DOSE_RATES_BEND), (1, DOSE_RATES_BEND), (0, LOOK), (1, LOOK)):
        assert abs(rates.per_s(worker, task) - many.per_s(worker, task)) < 0.1


def test_each_worker_has_rates_of_his_own_and_the_order_of_asking_changes_none(dose_rates_plan, rates):
    assert rates.per_s(0, DOSE_RATES_BEND) != rates.per_s(1, DOSE_RATES_BEND)
    other = DoseRates(dose_rates_plan, 0)
    assert [other.per_s(w, DOSE_RATES_BEND) for w in (1, 0)] == [rates.per_s(w, DOSE_RATES_BEND) for w in (1, 0)]


def test_the_mean_is_weighted_by_time():
    """Two performances of 1 s and 3 s in two parts each, RULA 2, 2 and 4, 4: (2 + 12) / 4 = 3.5."""

    class Block:
        duration_s = np.array([1.0, 3.0])

    class Task:
        name, handling = "bend", None

    dose_rates_plan = plans.plan(DOSE_RATES_CELL)
    measured = np.ones((2, 2, 30))
    found = DoseRates(dose_rates_plan, 0)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(dose_rates, "N_DRAWS", 2)
        patch.setattr(dose_rates, "measures_of", lambda *_: measured)
        patch.setattr(dose_rates, "bounds_of", lambda _: None)
        rula = np.array([[2, 2], [2, 3], [4, 4], [4, 7]])
        patch.setattr(dose_rates, "score", lambda *_: type("S", (), {"rula": rula}))
        assert found._mean_rula(Block, Task) == 3.5


def test_the_rates_of_a_plan_are_kept_for_its_next_replication(dose_rates_plan):
    assert dose_rates_of(dose_rates_plan, 0) is dose_rates_of(dose_rates_plan, 0)
    assert dose_rates_of(dose_rates_plan, 1) is not dose_rates_of(dose_rates_plan, 0)

"""What is in the hands of those who walk."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import simpy
from plans import plan, run_plan

from opsim import Worker, WorkerLog
from opsim.ergonomics.redraw import luck_of
from opsim.ergonomics.scores.scoring import WALKING
from opsim.ergonomics.shift.day import days, said_of
from opsim.ergonomics.shift.external import groups, models_of, natural, only, plan_of, rows_of, whole_days
from opsim.ergonomics.shift.frames import WALKING as WALKS
from opsim.ergonomics.shift.frames import handlings
from opsim.ergonomics.shift.ledger import Minutes, timeline
from opsim.ergonomics.shift.walks import carried_kg, carries
from opsim.external_draws import OwnLuck
from opsim.history import walk_rows
from opsim.log import COLUMNS, OFF, TRANSPORT, WAIT, WALK, WORK
from opsim.subjects.exposure.plan import NOT_SAID, Handling
from opsim.subjects.tools.plan import Moment
from opsim.tasks import Fixed
from tests.opsim.ergonomics.made_work import BEND, COUNT, made_plan
from tests.opsim.ergonomics.shift.test_booking import frames
from tests.opsim.kpi.made_logs import made, row, work
from tests.opsim.made_walks import walking

BODY, OTHER = object(), object()


def luck(name, models, handling=None, **how):
    one = OwnLuck(name, models, how.pop("seed", 1), 0, **how)
    one.handling = handling or {}
    return one


def by_name(*lucks):
    return {one.worker: one for one in lucks}


def test_who_means_the_same_by_a_task_is_in_one_group():
    same = by_name(luck("w10", {"a": BODY}), luck("w2", {"a": BODY, "b": OTHER}, seed=9), luck("x", {"c": BODY}))
    assert groups(same) == [["w2", "w10", "x"]]
    assert groups(by_name(luck("ana", {"a": Fixed(1.0)}), luck("ben", {"a": Fixed(2.0)}))) == [["ana", "ben"]]
    assert groups(by_name(luck("ana", {"a": BODY}), luck("ben", {"a": OTHER}), luck("cy", {"a": BODY}))) == [
        ["ana", "cy"],
        ["ben"],
    ]
    heavy = {"a": Handling(load_kg=9.0)}
    assert groups(by_name(luck("ana", {"a": BODY}, heavy), luck("ben", {"a": BODY}))) == [["ana"], ["ben"]]


def test_ranks_are_natural_and_models_those_of_the_group():
    lucks = by_name(luck("w10", {"t10": BODY, "t2": BODY}), luck("w2", {"t2": OTHER}))
    for name, model in (("w10", BODY), ("w2", OTHER)):
        plan = plan_of(lucks, [name])
        assert [worker.name for worker in plan.workers] == ["w2", "w10"]
        assert [task.name for task in plan.tasks] == ["t2", "t10"] and plan.tasks[0].model is model
    assert models_of(lucks.values()) == {"t2": OTHER, "t10": BODY}


def test_everybody_has_his_own_luck():
    lucks = by_name(luck("ana", {"a": BODY}), luck("ben", {"a": BODY}, seed=8))
    plan = plan_of(lucks, ["ana", "ben"])
    assert [luck_of(plan, rank, 0) for rank in (0, 1)] == [lucks["ana"], lucks["ben"]]


def test_what_is_said_now_comes_before_what_a_worker_says():
    own, now = Handling(load_kg=1.0), Handling(load_kg=2.0)
    lucks = by_name(luck("ana", {"a": BODY, "b": BODY, "c": BODY}, {"a": own, "b": own}))
    plan = plan_of(lucks, ["ana"], {"b": now}, window_s=(5.0, 9.0), start_s=60.0)
    assert [task.handling for task in plan.tasks] == [own, now, NOT_SAID]
    assert plan.window_s == (5.0, 9.0) and plan.start_s == 60.0


def test_a_body_is_read_from_keys_and_from_attributes():
    for body in ({"height_m": 1.7, "sex": "f"}, SimpleNamespace(height_m=1.7, sex="f")):
        plan = plan_of(by_name(luck("ana", {"a": BODY}, body=body)), ["ana"])
        assert (plan.workers[0].body.height_m, plan.workers[0].body.sex) == (1.7, "f")
        assert plan.workers[0].body.mass_kg is None


def shift(until=60.0):
    """w10 folds from 0 to 10, is broken off at 4 and goes on at 9; w2 tapes from 20 to 23. (log, pieces)"""
    env, log, done = simpy.Environment(), WorkerLog(), []
    tasks = {"fold": Fixed(10.0), "tape": Fixed(3.0)}
    w10, w2 = (Worker(env, name, tasks, log=log) for name in ("w10", "w2"))

    def folding():
        doing = w10.perform("fold")
        yield env.timeout(4.0)
        doing.interrupt()
        piece = yield doing
        yield env.timeout(5.0)
        done.extend([piece, (yield w10.resume(piece))])

    def taping():
        yield env.timeout(20.0)
        done.append((yield w2.perform("tape")))

    env.process(folding())
    env.process(taping())
    env.run(until=until)
    return log.close(), done


def test_rows_of_pieces_are_the_rows_of_work_of_the_log():
    log, done = shift()
    own, work = rows_of(done[::-1], 0), log.of(WORK)
    assert len(own) == 3 and own.horizon_s == 23.0
    for column in COLUMNS:
        assert np.array_equal(own[column], work[column], equal_nan=True), column


def test_a_piece_that_took_no_time_is_no_row():
    _, done = shift()
    assert len(rows_of([done[0].until(0.0)], 0)) == 0


def test_everybody_has_a_row_at_every_time_and_is_off_where_he_had_none():
    log, done = shift()
    days = whole_days(rows_of(done, 0), ["fold", "tape", "cut"], 2.0)
    assert days.names["task"] == ("cut", "fold", "tape")
    assert [days.names["task"][task] for task in days.of(WORK)["task"]] == ["fold", "fold", "tape"]
    off = days.of(OFF)
    found = sorted(zip(off["worker"].tolist(), off["start_s"].tolist(), off["end_s"].tolist()))
    w2, w10 = 0, 1
    assert found == [(w2, 2.0, 20.0), (w10, 4.0, 9.0), (w10, 15.0, 23.0)]
    assert len(whole_days(log, [], 0.0).of(OFF)) == 0  # a log says when he waited


def test_who_does_two_things_at_once_is_refused():
    _, done = shift()
    with pytest.raises(
        ValueError, match="worker w10: something else begins at 0 s, while the piece before lasts until 4 s"
    ):
        whole_days(rows_of([done[0], done[0]], 0), [], 0.0)


def test_only_some_workers_are_left_with_rows_by_the_same_numbers():
    log, _ = shift()
    mine = only(log, [1])
    assert set(mine["kind"][mine["worker"] == 0].tolist()) == {OFF}
    assert set(mine["kind"][mine["worker"] == 1].tolist()) == {WORK, WAIT}
    assert np.array_equal(mine["start_s"], log["start_s"]) and natural(["w10", "w2", "w2"]) == ("w2", "w10")


MODELS = {"lift": SimpleNamespace(mark_names=("grasp", "release")), "look": object()}


def test_words_and_a_handling_are_the_same():
    said = Handling(load_kg=8, grip="fair", start=Moment(mark=0), end=Moment(share=0.9))
    words = {"load_kg": 8, "grip": "fair", "start": "grasp", "end": 0.9, "legs": None}
    assert handlings({"lift": words}, MODELS) == handlings({"lift": said}, MODELS) == {"lift": said}
    assert handlings({"lift": {"end": 1}}, MODELS)["lift"] == Handling(end=Moment(share=1.0))


def test_nothing_said_is_nothing():
    assert handlings(None, MODELS) == {} and handlings({"look": {}}, MODELS) == {"look": Handling()}


@pytest.mark.parametrize(
    ("said", "found"),
    [
        ({"lft": {}}, "no task 'lft'; did you mean 'lift'?"),
        ({"lift": 3}, "handling of lift: expected a Handling or its words, found 3"),
        ({"lift": {"load": 8}}, "no 'load'; did you mean 'load_kg'?"),
        ({"lift": {"load_kg": "8 kg"}}, "load_kg: found '8 kg', expected kilograms from 0"),
        ({"lift": {"load_kg": float("nan")}}, "expected kilograms from 0"),
        ({"lift": {"load_kg": True}}, "expected kilograms from 0"),
        ({"lift": Handling(grip="fiar")}, "grip: no 'fiar'; did you mean 'fair'?"),
        ({"lift": {"sitting": "no"}}, "sitting: found 'no', expected True or False"),
        ({"lift": {"start": "gras"}}, "no mark 'gras'; the movement has: grasp, release"),
        ({"look": {"start": "grasp"}}, "the movement has: none"),
        ({"lift": {"end": 1.5}}, "end: found 1.5, expected the name of a mark, or a share from 0 to 1"),
    ],
)
def test_a_mistake_is_named_with_its_place(said, found):
    with pytest.raises(ValueError) as caught:
        handlings(said, MODELS)
    assert found in str(caught.value)


def test_all_mistakes_are_said_at_once():
    with pytest.raises(ValueError) as caught:
        handlings({"lift": {"load_kg": -1, "grip": "x"}, "lok": {}}, MODELS)
    assert len(str(caught.value).splitlines()) == 3
    with pytest.raises(TypeError, match="expected a mapping"):
        handlings([1], MODELS)


def of(*rula):
    return SimpleNamespace(rula=np.array(rula, np.int8))


def stretch(worker, start_s, seconds):
    nothing = [0] * len(seconds)
    return frames(worker, start_s, seconds, nothing, nothing, nothing, nothing, np.zeros((len(seconds), 2)))


def test_frames_are_shared_out_to_the_minutes_they_lie_in():
    minutes = Minutes(made_plan(warm_up_s=60.0, horizon_s=300.0))
    minutes.add(stretch(0, [70, 110, 150], [40, 40, 90]), of((3, 5), (6, 7), (0, 0)))
    minutes.add(stretch(1, [60], [60]), of((5, 5)))
    found = minutes.close()
    assert found.edge_s.tolist() == [60, 120, 180, 240, 300]
    assert found.known_s.tolist() == [[50, 30, 0, 0], [60, 0, 0, 0]]
    assert found.unknown_s.tolist() == [[0, 30, 60, 0], [0, 0, 0, 0]]
    assert found.rula_low[0, :2].tolist() == [(3 * 40 + 6 * 10) / 50, 6] and np.isnan(found.rula_low[0, 2:]).all()
    assert found.rula_high[0, 0] == (5 * 40 + 7 * 10) / 50
    assert found.from_5_s[0].tolist() == [10, 30, 0, 0] and found.from_5_at_most_s[0].tolist() == [50, 30, 0, 0]


def test_all_minutes_together_are_the_time_at_work():
    plan = made_plan(horizon_s=1000.0, warm_up_s=30.0)
    rows = [work(20 + 9.5 * k, 29 + 9.5 * k, 0, worker=0, k=k, task=BEND) for k in range(40)]
    rows.append(work(500, 700, 0, worker=1, k=0, task=COUNT))
    found = timeline(made(rows, plan), plan)
    assert found.known_s.sum() == pytest.approx(8.5 + 38 * 9)
    assert found.unknown_s[1].sum() == pytest.approx(200) and found.known_s.max() <= 60 + 1e-9
    assert found.unknown_s[1][8:11].tolist() == pytest.approx([40, 60, 60])


CELL = """
opsim: 1
name: carrying
run: {horizon: 30 min, seed: 3}
layout: {places: {a: [0 m, 0 m], b: [6 m, 0 m], c: [6 m, 6 m]}}
tasks: {cut: {fixed: 20 s}}
stations: {s1: {at: a, tasks: [cut], buffer: 3}, s2: {at: b, tasks: [cut], buffer: 3}, s3: {at: c, tasks: [cut]}}
products: {p: {route: [s1, s2], carried: true, mass: 4 kg, lot: 3, share: 0.5}, q: {route: [s2, s3], share: 0.5}}
release: {kind: poisson, every: 40 s}
workers:
  ana: {most_load: 5 kg, skills: {s1: 1.0, s2: 1.0, s3: 1.0}}
  ben: {skills: {s1: 1.0, s2: 1.0}}
"""


@pytest.fixture(scope="module")
def run():
    of = walking(plan(CELL))
    return of, run_plan(of)


def test_walks_from_station_to_station_with_a_job_that_is_carried_are_full_and_all_others_empty(run):
    of, log = run
    rows = walk_rows(log)
    full = carries(log, of, rows)
    ways = set(zip(log["place_from"][rows[full]].tolist(), log["place_to"][rows[full]].tolist()))
    assert ways == {(0, 1)} and set(log["product"][rows[full]].tolist()) == {0}
    assert 0 < full.sum() < rows.size


def test_a_lot_is_brought_in_several_ways_and_the_ways_back_are_empty():
    """12 kg of units of 4 kg, 5 kg at once: three ways there, two back."""
    ways = [row(WALK, 10 * n, 10 * n + 10, worker=0, places=(n % 2, 1 - n % 2), job=7) for n in range(5)]
    log = made([*ways, row(WALK, 60, 70, worker=0, places=(0, 1), job=7), row(TRANSPORT, 0, 50, job=7)], plan(CELL))
    assert carries(log, plan(CELL), walk_rows(log)).tolist() == [True, False, True, False, True, False]
    assert not carries(made(ways, plan(CELL)), plan(CELL), walk_rows(made(ways, plan(CELL)))).any()


def test_what_is_in_the_hands_is_as_much_as_he_may_carry_at_once():
    of = plan(CELL)
    assert (carried_kg(of, 0, 0), carried_kg(of, 1, 0), carried_kg(of, 1, 1)) == (4.0, 12.0, None)


def test_walking_frames_carry_what_the_walk_carries(run):
    of, log = run
    for some in days(log, of):
        walks = some.task == WALKS
        rows = walk_rows(log)
        full = dict(zip(rows.tolist(), carries(log, of, rows).tolist()))
        assert some.carrying[walks].tolist() == [full[at] for at in some.row[walks].tolist()]


def test_scores_of_walks_know_the_mass_of_what_is_carried():
    of = plan(CELL)
    found = said_of(WALKS, of, 0, 1)  # 12 kg: RULA 2 now and then, 3 steadily; REBA 2 (over 10 kg, no shock); OWAS 2
    assert (found.rula_force, found.reba_load, found.owas_load) == ((2, 3), (2, 2), (2, 2))
    assert (found.coupling, found.walking) == ((0, 3), True)
    unknown = said_of(WALKS, of, 1, 1)
    assert unknown == said_of(WALKS, of) == replace(WALKING, reba_load=(0, 2))
    light = replace(of, products=tuple(replace(one, mass_kg=0.0) for one in of.products))
    assert said_of(WALKS, light, 0).reba_load == (0, 0)
    assert np.isfinite(carried_kg(light, 0, 0))

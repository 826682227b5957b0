import math
import re
from types import SimpleNamespace

import numpy as np
import pytest
import simpy
from simpy.rt import RealtimeEnvironment

from opsim import Worker, WorkerLog, run_plan
from opsim.clock import on_grid
from opsim.external_worker import WorkerBusy, library_model
from opsim.log import WORK
from opsim.streams import stream
from opsim.tasks import Exponential, Fixed, Gamma, Lognormal, Recorded
from opsim.worker_effects import worker_effect
from tests.plans import plan

SECOND = 2.0**-20


def run(worker, story):
    """What a process of this worker returns, run to the end of all events."""
    process = worker.env.process(story(worker))
    worker.env.run()
    return process.value


def several(task, n):
    def story(worker):
        done = []
        for _ in range(n):
            done.append((yield worker.perform(task)))
        return done

    return story


def ana(tasks=None, **how):
    return Worker(simpy.Environment(), "ana", tasks or {"fold": Fixed(10.0), "tape": Exponential(4.0)}, **how)


def stopped(after_s, task="fold"):
    """A story: begin a task, stop it after a while, return the piece."""

    def story(worker):
        doing = worker.perform(task)
        yield worker.env.timeout(after_s)
        doing.interrupt("rush order")
        return (yield doing)

    return story


# --------------------------------------------------------------------------------------------------- whole performances
def test_a_performance_takes_its_time_and_says_so():
    done = run(ana(), several("fold", 2))
    assert [(p.worker, p.task, p.k, p.start_s, p.end_s, p.duration_s) for p in done] == [
        ("ana", "fold", 0, 0.0, 10.0, 10.0),
        ("ana", "fold", 1, 10.0, 20.0, 10.0),
    ]
    assert all(p.finished and p.left_s == 0 and (p.progress_from, p.progress_to) == (0, 1) for p in done)


def test_perform_is_a_plain_simpy_process():
    worker = ana()
    doing = worker.perform("fold")
    assert isinstance(doing, simpy.Process) and worker.busy and doing.is_alive
    first = worker.env.run(until=doing | worker.env.timeout(30))
    assert doing in first and not worker.busy and worker.env.now == 10


SCENARIO = """
opsim: 1
name: twin
run: {horizon: 3 h, seed: 5}
libraries: {moves: libraries/public_movements.npz}
layout: {places: {bench: [0 m, 0 m]}}
tasks:
  squat: {emulator: moves/deep_squat}
  label: {dist: lognormal, mean: 20 s, cv: 0.3, between_share: 0.5}
  grind: {dist: gamma, mean: 9 s, cv: 0.5}
stations: {bench: {at: bench, tasks: [squat, label, grind], buffer: 1}}
products: {unit: {route: [bench]}}
release: {kind: saturated}
workers: {ana: {skills: {bench: 1.1}, height: 1.62 m}}
"""


@pytest.mark.parametrize("replication", [0, 3])
def test_a_worker_has_the_times_of_the_engine_where_names_and_seed_are_the_same(replication):
    engine = run_plan(plan(SCENARIO), replication).of(WORK)
    models = {
        "squat": "public_movements/deep_squat",
        "label": Lognormal(20.0, 0.3, 0.5),
        "grind": Gamma(9.0, 0.5),
    }
    body = {"height_m": 1.62}
    worker = ana(models, seed=5, replication=replication, rating=1.1, body=body)

    def story(worker):
        for _ in range(100):
            for task in models:
                yield worker.perform(task)

    run(worker, story)
    own = worker.log.close().of(WORK)
    assert len(engine) > 300
    whole = slice(0, 300)
    assert np.array_equal(own["start_s"][whole], engine["start_s"][whole])
    assert np.array_equal(own["end_s"][whole], engine["end_s"][whole])
    assert np.array_equal(own["k"][whole], engine["k"][whole])


def test_a_trace_gives_performance_k_its_own_time():
    done = run(ana({"fold": Recorded((1.0, 2.0, 3.0), by_index=True)}), several("fold", 70))
    assert [p.duration_s for p in done] == [1.0 + k % 3 for k in range(70)]


def test_nobody_s_luck_moves_when_tasks_or_workers_are_added():
    alone = run(ana({"tape": Exponential(4.0)}), several("tape", 5))

    def with_fold(worker):
        found = []
        for _ in range(5):
            yield worker.perform("fold")
            found.append((yield worker.perform("tape")))
        return found

    assert [p.duration_s for p in alone] == [p.duration_s for p in run(ana(), with_fold)]


def test_seed_replication_and_name_decide_the_luck():
    def first(**how):
        return run(ana(**how), several("tape", 1))[0].duration_s

    assert first() == first() and len({first(), first(seed=1), first(replication=1)}) == 3


def test_a_workforce_decides_who_the_worker_is_and_a_replication_only_his_luck():
    model = {"tape": Lognormal(20.0, 0.5, between_share=1.0)}

    def first(**how):
        return run(ana(model, **how), several("tape", 1))[0].duration_s

    assert first(replication=1) == first(replication=2) != first(workforce=1)


def test_durations_are_on_the_grid_and_rounded_once_after_the_rating():
    drawn = run(ana(), several("tape", 100))
    rated = run(ana(rating=1.3), several("tape", 100))
    assert all((p.duration_s / SECOND).is_integer() for p in rated)
    assert [p.duration_s for p in rated] == [on_grid(p.drawn.duration_s / 1.3) for p in drawn]


# ------------------------------------------------------------------------------------------------- interrupted, resumed
def test_an_interrupted_performance_ends_well_with_the_piece_that_was_done():
    worker = ana()
    piece = run(worker, stopped(4.0))
    assert not piece.finished and (piece.progress_from, piece.progress_to) == (0.0, 0.4)
    assert (piece.start_s, piece.end_s, piece.duration_s, piece.left_s) == (0.0, 4.0, 10.0, 6.0)
    assert not worker.busy


def test_resume_goes_on_with_the_same_performance_where_it_stopped():
    def story(worker):
        first = yield from stopped(4.0)(worker)
        other = yield worker.perform("tape")
        rest = yield worker.resume(first)
        following = yield worker.perform("fold")
        return first, other, rest, following

    first, other, rest, following = run(ana(), story)
    assert (rest.k, rest.number, rest.progress_from, rest.progress_to) == (first.k, first.number, 0.4, 1.0)
    assert rest.finished and rest.start_s == other.end_s and rest.end_s == other.end_s + 6.0
    assert following.k == first.k + 1


def test_pieces_of_a_performance_take_exactly_its_time_however_often_it_is_stopped():
    def story(worker):
        doing, pieces = worker.perform("tape"), []
        for wait_s in (0.1, 1 / 3, 0.7, 0.0, 0.01):
            yield worker.env.timeout(wait_s)
            doing.interrupt()
            pieces.append((yield doing))
            yield worker.env.timeout(math.pi / 10)
            doing = worker.resume(pieces[-1])
        return [*pieces, (yield doing)]

    pieces = run(ana({"tape": Fixed(7.123)}), story)
    spent = [round((p.end_s - p.start_s) / SECOND) for p in pieces]
    assert sum(spent) * SECOND == pieces[0].duration_s == on_grid(7.123)
    assert [p.progress_to for p in pieces[:-1]] == [p.progress_from for p in pieces[1:]] and pieces[-1].finished


def test_an_interrupt_at_the_instant_of_the_end_finds_the_performance_finished():
    worker = ana()
    alarm = worker.env.timeout(10.0)

    def alarmed(worker):
        doing = worker.perform("fold")
        yield alarm
        assert doing.is_alive
        doing.interrupt()
        return (yield doing)

    done = run(worker, alarmed)
    assert done.finished and done.end_s == 10.0


def test_an_interrupt_at_the_instant_of_the_start_leaves_everything_to_do_and_no_row():
    worker = ana()
    piece = run(worker, stopped(0.0))
    assert (piece.progress_to, piece.left_s) == (0.0, 10.0)
    assert len(worker.log.close().of(WORK)) == 0


def test_an_interrupt_of_the_waiting_process_does_not_touch_the_performance():
    worker = ana()

    def impatient(worker):
        try:
            yield worker.perform("fold")
        except simpy.Interrupt:
            return worker.busy

    waiting = worker.env.process(impatient(worker))

    def boss():
        yield worker.env.timeout(3)
        waiting.interrupt()

    worker.env.process(boss())
    worker.env.run()
    assert waiting.value is True and worker.log.close().of(WORK)["end_s"].tolist() == [10.0]


@pytest.mark.parametrize(
    ("which", "said"),
    [
        ("finished", "it is finished"),
        ("twice", "it has been finished since"),
        ("older", "from 20%: it has gone on to 50% since"),
        ("stranger", "it is ben's"),
    ],
)
def test_only_the_last_piece_of_an_unfinished_performance_of_one_s_own_can_be_resumed(which, said):
    def story(worker):
        first = yield from stopped(2.0)(worker)
        doing = worker.resume(first)
        yield worker.env.timeout(3.0)
        doing.interrupt()
        second = yield doing
        if which == "older":
            worker.resume(first)
        last = yield worker.resume(second)
        worker.resume(last if which == "finished" else first)

    def of_ben(worker):
        ben = Worker(worker.env, "ben", {"fold": Fixed(10.0)})
        worker.resume((yield from stopped(2.0)(ben)))

    with pytest.raises(ValueError, match=said):
        run(ana(), of_ben if which == "stranger" else story)


# ------------------------------------------------------------------------------------------------- one thing at a time
def test_who_is_busy_cannot_begin_another_thing_and_says_until_when():
    worker = ana()
    worker.env.run(until=2.0)
    worker.perform("fold")
    worker.env.run(until=5.0)
    with pytest.raises(
        WorkerBusy, match=r"ana: cannot perform tape at 5 s, is busy with fold until 12 s; .*request\(\)"
    ):
        worker.perform("tape")


def test_processes_take_turns_as_with_any_resource():
    worker, order = ana(), []

    def customer(name):
        with worker.request() as turn:
            yield turn
            done = yield worker.perform("fold")
            order.append((name, done.start_s))

    for name in "abc":
        worker.env.process(customer(name))
    worker.env.run()
    assert order == [("a", 0.0), ("b", 10.0), ("c", 20.0)]


# --------------------------------------------------------------------------------------------------------- environments
@pytest.mark.parametrize("start", [0.1, 1.7e9 + 0.3, -50.0])
def test_an_environment_may_start_at_any_time(start):
    worker = Worker(simpy.Environment(initial_time=start), "ana", {"fold": Fixed(10.0)})
    piece = run(worker, stopped(4.0))
    assert piece.start_s == start and piece.progress_to == pytest.approx(0.4, abs=1e-6)
    log = worker.log.close()
    assert log["start_s"].min() == start and log.horizon_s == worker.env.now


def test_an_environment_may_run_in_real_time():
    env = RealtimeEnvironment(factor=0.001, strict=False)
    done = run(Worker(env, "ana", {"fold": Fixed(10.0)}), several("fold", 2))
    assert [p.end_s for p in done] == [10.0, 20.0]


# -------------------------------------------------------------------------------------------------------------- bad use
SHORT = SimpleNamespace(
    draw_worker=lambda rng, body=None: None,
    mean_duration_s=lambda worker=None: 1.0,
    sample=lambda n, rng, **_: SimpleNamespace(duration_s=np.full(n, -1.0), mark_s=np.empty((n, 0))),
)


@pytest.mark.parametrize(
    ("change", "error", "said"),
    [
        ({"env": 5}, TypeError, "expected a simpy.Environment first, found 5"),
        ({"name": ""}, TypeError, "expected a name as text"),
        ({"tasks": [Fixed(1.0)]}, TypeError, "expected a mapping of names to task models"),
        ({"tasks": {}}, ValueError, "at least one"),
        ({"tasks": {"fold": 12.0}}, TypeError, "task fold: .*float without mean_duration_s, draw_worker, sample"),
        ({"tasks": {"fold": Fixed}}, TypeError, "task fold: expected a TaskModel"),
        ({"tasks": {1: Fixed(1.0)}}, TypeError, "names as text, found 1"),
        ({"tasks": {"fold": "deep_squat"}}, ValueError, "task fold: expected library/task, found 'deep_squat'"),
        ({"tasks": {"fold": "public_movement/x"}}, ValueError, "did you mean 'public_movements'?"),
        ({"tasks": {"fold": "public_movements/deep_sqat"}}, ValueError, "did you mean 'deep_squat'?"),
        ({"seed": -1}, ValueError, "seed must be a whole number from 0, found -1"),
        ({"replication": 0.5}, ValueError, "replication must be a whole number"),
        ({"rating": -1.0}, ValueError, "rating must be a number above 0, found -1"),
        ({"rating": math.nan}, ValueError, "rating"),
        ({"across_tasks": "same_pase"}, ValueError, "across_tasks: no 'same_pase'; did you mean 'same_pace'"),
        ({"rating": "1.1"}, ValueError, "rating must be a number above 0, found '1.1'"),
        ({"body": 1.62}, TypeError, "body must have one of height_m, mass_kg"),
        ({"body": {"height": 1.62}}, ValueError, "did you mean 'height_m'?"),
        ({"log": []}, TypeError, "must be a WorkerLog"),
    ],
)
def test_a_wrong_argument_is_named_with_what_is_right(change, error, said):
    right = {"env": simpy.Environment(), "name": "ana", "tasks": {"fold": Fixed(1.0)}}
    with pytest.raises(error, match=said):
        Worker(**{**right, **change})


def test_an_unknown_task_is_answered_with_the_nearest_word():
    with pytest.raises(ValueError, match=r"worker ana: no task 'fould'; did you mean 'fold'\?"):
        ana().perform("fould")
    with pytest.raises(TypeError, match="expected a Performance to resume, found 'fold'"):
        ana().resume("fold")


def test_a_model_that_draws_what_is_no_time_is_named():
    with pytest.raises(ValueError, match=r"task fold: SimpleNamespace.sample gave -1 to -1 s, expected 64 positive"):
        ana({"fold": SHORT}).perform("fold")


def test_workers_of_one_log_are_of_one_environment_and_replication_and_have_names_of_their_own():
    log, env = WorkerLog(), simpy.Environment()
    Worker(env, "ana", {"fold": Fixed(1.0)}, log=log)
    for other, said in [
        ((env, "ana", {"fold": Fixed(1.0)}, 0), "there is a worker 'ana' in it already"),
        ((simpy.Environment(), "ben", {"fold": Fixed(1.0)}, 0), "another environment"),
        ((env, "ben", {"fold": Fixed(1.0)}, 2), "is of replication 2, the log of 0"),
    ]:
        with pytest.raises(ValueError, match=said):
            Worker(*other[:3], replication=other[3], log=log)


@pytest.mark.parametrize(
    ("body", "said"),
    [
        *(({"height_m": height_m}, "must lie between") for height_m in (170, -1.0, float("nan"))),
        ({"mass_kg": 0}, "must lie between"),
        ({"age_years": 4}, "age_years must lie between 5 and 110, found 4"),
        ({"pace": 11}, "pace must lie between 0.3 and 3, found 11"),
        ({"sex": "x"}, "sex must be 'f' or 'm', found 'x'"),
        ({"person": "s3"}, "no person 's3' was recorded in these tasks; did you mean 's03'?"),
    ],
)
def test_a_body_that_nobody_has_is_refused(body, said):
    with pytest.raises(ValueError, match=re.escape(said)):
        Worker(simpy.Environment(), "ana", {"t": Fixed(1.0), "squat": "public_movements/deep_squat"}, body=body)


def test_a_recorded_person_is_refused_where_nothing_was_recorded():
    with pytest.raises(ValueError, match="no person 's03' was recorded in these tasks; none of them is emulated"):
        Worker(simpy.Environment(), "ana", {"t": Fixed(1.0)}, body={"person": "s03"})


def test_a_worker_who_is_a_recorded_person_moves_as_that_one():
    squat = library_model("public_movements/deep_squat")
    who = worker_effect(squat, "squat", "ana", 3, 0, {"person": "s03"})
    assert who.name == "s03"
    known = squat.sample(64, stream(3, 0, "duration", "squat", "ana", 0), worker=who).duration_s
    worker = ana({"squat": squat}, seed=3, body={"person": "s03"})

    def story(worker):
        for k in range(5):
            done = yield worker.perform("squat")
            assert done.drawn.duration_s == known[k]

    run(worker, story)

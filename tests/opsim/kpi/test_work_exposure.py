"""Figures of walking, where it has postures."""

import pickle
from dataclasses import dataclass, replace

import numpy as np
import pytest
import simpy
from hypothesis import given, settings
from hypothesis import strategies as st
from plans import plan as plan_of_posture_walking

from opsim import Worker, WorkerLog, exposure_of, read_events, run_plan, write_events
from opsim.engine.floor.run import run_plan as run_plan_of_posture_walking
from opsim.ergonomics import Handling, Options
from opsim.kpi import figures
from opsim.kpi.catalogue import EXPOSURE, POSTURE, SCORED, WALKING, headline
from opsim.log import WALK
from opsim.subjects.exposure.figures import exposure
from opsim.tasks import Fixed
from tests.opsim.ergonomics.made_work import Bending, Bends, BendsApart
from tests.opsim.kpi.made_logs import made, row, work
from tests.opsim.made_walks import Walk, walking
from tests.plans import plan

SAID = Handling(load_kg=6.0, grip="fair", force="repeated", forearm="mid", legs="balanced", sitting=False)


def worked(story, tasks=None, *, until=None, names=("ana",), log=None, **how):
    """The log of workers who each do as a story tells, and what they did."""
    env, log, done = simpy.Environment(), log or WorkerLog(), []
    workers = [Worker(env, name, tasks or {"bend": Bending()}, log=log, **how) for name in names]
    for worker in workers:
        env.process(story(worker, done))
    env.run(until=until)
    return log, done, workers


def times(n, task="bend"):
    def story(worker, done):
        for _ in range(n):
            done.append((yield worker.perform(task)))

    return story


def idle(worker, done):
    yield worker.env.timeout(5.0)


def stopped_at(after_s, go_on):
    def story(worker, done):
        doing = worker.perform("bend")
        yield worker.env.timeout(after_s)
        doing.interrupt()
        piece = yield doing
        done.append(piece)
        if go_on:
            yield worker.env.timeout(100.0)
            done.append((yield worker.resume(piece)))

    return story


# ------------------------------------------------------------------------------------------------------- known answers
def test_a_bend_to_90_degrees_and_back_is_beyond_20_for_seven_ninths_of_its_time():
    """up_and_down: flexion is 20 at shares 1/9 and 8/9, 60 at 1/3 and 2/3; 9 s each, 3 of them."""
    log, done, _ = worked(times(3))
    for did in (log, done):
        seen = exposure_of(did)
        assert seen.minutes() == pytest.approx(27 / 60)
        assert seen.minutes("trunk_beyond_20") == pytest.approx(21 / 60, abs=1e-6)
        assert seen.minutes("trunk_beyond_60", worker="ana", task="bend") == pytest.approx(9 / 60, abs=1e-6)


def test_of_a_performance_that_was_broken_off_only_what_was_done_counts():
    """Stopped after 3 of 9 s, at 60 degrees: beyond 20 from 1 s to 3 s."""
    log, done, _ = worked(stopped_at(3.0, go_on=False))
    for did in (log, done):
        seen = exposure_of(did)
        assert seen.minutes() * 60 == pytest.approx(3.0)
        assert seen.minutes("trunk_beyond_20") * 60 == pytest.approx(2.0, abs=1e-6)
        assert seen.minutes("trunk_beyond_60") == 0


def test_pieces_are_as_much_as_the_whole():
    parts, _, _ = worked(stopped_at(3.0, go_on=True))
    whole, _, _ = worked(times(1))
    in_parts, at_once = exposure_of(parts), exposure_of(whole)
    for level in (None, "trunk_beyond_20", "trunk_beyond_60", "arm_beyond_60"):
        assert in_parts.minutes(level) == pytest.approx(at_once.minutes(level), abs=1e-9)


def test_an_hour_is_one_in_which_he_is_there_or_in_which_he_works():
    """9 s of work in 90 s, of which 7 s are beyond 20 degrees; from a log he is there all the time."""
    log, done, _ = worked(times(1), until=90.0)
    by_log, by_pieces = exposure_of(log), exposure_of(done)
    part = "trunk_beyond_20"
    assert by_log.value("exposure_by_task", "bend", part) == pytest.approx(7 / 60 / (90 / 3600), rel=1e-5)
    assert by_pieces.value("exposure_by_task", "bend", part) == pytest.approx(7 / 60 / (9 / 3600), rel=1e-5)


# -------------------------------------------------------------------------------------------------------- as a scenario
SCENARIO = """
opsim: 1
name: twin
run: {horizon: 20 min, seed: 5}
libraries: {moves: libraries/public_movements.npz}
layout: {places: {bench: [0 m, 0 m]}}
tasks:
  squat: {emulator: moves/deep_squat, load: 6 kg,
          handling: {grip: fair, force: repeated, forearm: mid, legs: balanced, sitting: false}}
  lunge: {emulator: moves/side_lunge}
  label: {dist: lognormal, mean: 20 s, cv: 0.3, between_share: 0.5}
stations: {bench: {at: bench, tasks: [squat, lunge, label], buffer: 1}}
products: {unit: {route: [bench]}}
release: {kind: saturated}
workers: {ana: {skills: {bench: 1.1}, height: 1.62 m}}
"""


@pytest.mark.parametrize("options", [Options(), Options(rate_hz=6.0, waiting="upright", rula_table_a="worksheet2000")])
def test_the_same_work_has_the_figures_of_a_scenario(options):
    from opsim.tasks import Lognormal

    models = {
        "squat": "public_movements/deep_squat",
        "lunge": "public_movements/side_lunge",
        "label": Lognormal(20.0, 0.3, 0.5),
    }

    def story(worker, done):
        while True:
            for task in models:
                yield worker.perform(task)

    how = {"seed": 5, "rating": 1.1, "body": {"height_m": 1.62}}
    log, _, _ = worked(story, models, until=1200.0, **how)
    compiled = replace(plan(SCENARIO), ergonomics=options)
    in_scenario = run_plan(compiled, 0)
    asked = (*SCORED, "static_hold_min_per_h", "composite_lifting_index", "exposure_by_region")
    theirs = {(one.kpi, one.subject, one.part): one.value for one in exposure(in_scenario, compiled, asked)}
    seen = exposure_of(log, handling={"squat": SAID}, options=options, figures=asked, start_s=compiled.start_s)
    ours = {(one.kpi, one.subject, one.part): one.value for one in seen.figures}
    elsewhere = {key for key in theirs if key[0] in ("exposure_by_station", "exposure_by_product")}
    assert len(theirs) - len(elsewhere) > 100
    for key in theirs.keys() - elsewhere:
        assert ours[key] == pytest.approx(theirs[key], rel=1e-9, abs=1e-9, nan_ok=True), key


# ----------------------------------------------------------------------------------------------------------------- laws
def test_least_is_never_more_than_most_and_saying_more_makes_the_way_between_shorter():
    log, _, _ = worked(times(2), {"bend": "public_movements/deep_squat"})
    open_, said = exposure_of(log), exposure_of(log, handling={"bend": SAID})
    for level in ("rula_from_5", "rula_from_7", "reba_from_8", "owas_from_3"):
        low, high = (said.minutes(level, at_most=at_most) for at_most in (False, True))
        least, most = open_.minutes(level) - 1e-12, open_.minutes(level, at_most=True) + 1e-12
        assert least <= low <= high + 1e-12 <= most + 1e-12


def test_a_log_pieces_in_any_order_a_file_and_another_process_say_the_same(tmp_path):
    log, done, workers = worked(times(3), {"bend": "public_movements/deep_squat"}, names=("w2", "w10"))
    write_events(log.close(), tmp_path / "events.parquet")
    ways = [
        exposure_of(log),
        exposure_of(done[::-1]),
        exposure_of(read_events(tmp_path / "events.parquet"), workers),
        exposure_of(pickle.loads(pickle.dumps(done))),
    ]
    for other in ways[1:]:
        assert np.array_equal(other.ledger.key, ways[0].ledger.key)
        for name, seconds in ways[0].ledger.bins.items():
            assert np.allclose(other.ledger.bins[name], seconds, rtol=0, atol=1e-9), name


def test_each_performance_is_looked_at_once_whatever_it_was_broken_into():
    looked = []

    class Counted(BendsApart):
        def positions_m(self, n_times):
            if n_times > 2:  # 2: how performances begin, for the neutral of necks
                looked.append(len(self.duration_s))
            return super().positions_m(n_times)

    def story(worker, done):
        for _ in range(3):
            doing = worker.perform("bend")
            while True:
                yield worker.env.timeout(4.0)
                if not doing.is_alive:
                    break
                doing.interrupt()
                piece = yield doing
                yield worker.env.timeout(1200.0)  # so that pieces of one performance lie in different hours
                doing = worker.resume(piece)

    log, _, _ = worked(story, {"bend": Bending(kind=Counted)})
    seen = exposure_of(log)
    assert sum(looked) == 3
    assert seen.minutes() == pytest.approx(27 / 60) and seen.minutes("trunk_beyond_20") * 60 == pytest.approx(
        21, abs=1e-5
    )


@settings(deadline=None, max_examples=10)
@given(st.lists(st.floats(0.01, 12.0), min_size=1, max_size=6))
def test_whatever_it_is_broken_into_no_second_is_lost_or_counted_twice(stops_s):
    """Each performance is stopped after each of these times, while it lasts, and gone on with later."""
    done = []

    def story(worker, _):
        for _ in range(2):
            doing = worker.perform("bend")
            for after_s in stops_s:
                yield worker.env.timeout(after_s)
                if not doing.is_alive:
                    break
                doing.interrupt()
                done.append((yield doing))
                yield worker.env.timeout(1.0)
                doing = worker.resume(done[-1])
            else:
                yield doing
            done.append(doing.value)

    log, _, _ = worked(story)
    for seen in (exposure_of(log), exposure_of(done)):
        assert seen.ledger.seconds.sum() == pytest.approx(18.0, abs=1e-5)
        assert seen.minutes("trunk_beyond_20") * 60 == pytest.approx(14.0, abs=1e-4)


def test_workers_who_mean_different_work_by_one_name_are_each_scored_by_their_own():
    deep, shallow = Bending(), Bending(depth_deg=(45.0,) * 64)
    env, log = simpy.Environment(), WorkerLog()
    ana, ben = Worker(env, "ana", {"bend": deep}, log=log), Worker(env, "ben", {"bend": shallow}, log=log, seed=3)
    for worker in (ana, ben):
        env.process(times(2)(worker, []))
    env.run()
    seen = exposure_of(log)
    assert seen.minutes("trunk_beyond_60", worker="ana") == pytest.approx(6 / 60, abs=1e-6)
    assert seen.minutes("trunk_beyond_60", worker="ben") == 0
    assert seen.minutes("trunk_beyond_20", worker="ben") == pytest.approx(
        10 / 60, abs=2e-3
    )  # 20 of 45: 4/9 of each half


def test_what_a_model_reads_of_a_body_it_is_given_again_as_it_was():
    @dataclass(frozen=True)
    class OfHeight(Bending):
        def draw_worker(self, rng, body=None):
            return body["height_m"]

        def sample(self, n, rng, *, worker=None, condition=None):
            depth = 90.0 if worker is None else 10.0 * worker
            return self.kind(np.full(n, 9.0), np.full(n, depth), self.skeleton)

    log, _, _ = worked(times(1), {"bend": OfHeight()}, body={"height_m": 1.5})
    assert exposure_of(log).minutes("trunk_beyond_20") == 0


def test_what_was_before_is_not_counted():
    log, _, _ = worked(times(3))
    seen = exposure_of(log, from_s=9.0)
    assert seen.minutes() == pytest.approx(18 / 60)


def test_who_comes_late_is_there_from_then_on():
    env, log = simpy.Environment(), WorkerLog()

    def late():
        yield env.timeout(60.0)
        yield Worker(env, "ben", {"bend": Bending()}, log=log).perform("bend")

    Worker(env, "ana", {"bend": Bending()}, log=log)
    env.process(late())
    env.run(until=120.0)
    seen = exposure_of(log)
    there_h = 180 / 3600  # ana two minutes, ben one
    assert seen.value("exposure_by_task", "bend", "trunk_beyond_20") == pytest.approx(7 / 60 / there_h, rel=1e-5)


def test_times_without_a_body_are_unknown_and_never_nothing():
    log, _, _ = worked(times(2), {"bend": Fixed(30.0)})
    seen = exposure_of(log)
    assert seen.minutes() == 1.0 and np.isnan(seen.minutes("rula_from_5"))
    assert seen.value("posture_measured_share") == 0.0
    assert "?" in str(seen)


def test_what_a_worker_says_is_in_his_hands_is_scored_and_what_is_said_later_comes_first():
    tasks = {"bend": "public_movements/deep_squat"}
    log, _, _ = worked(times(2), tasks, handling={"bend": SAID})
    silent, _, _ = worked(times(2), tasks)
    said, later = exposure_of(silent, handling={"bend": SAID}), exposure_of(log, handling={"bend": {"load_kg": 25}})
    for name, seconds in exposure_of(log).ledger.bins.items():
        assert np.array_equal(seconds, said.ledger.bins[name]), name
    assert later.worst()[0].load_kg == 25 and exposure_of(log).worst()[0].load_kg == 6


def test_one_task_with_different_loads_is_scored_by_each_workers_own():
    env, log = simpy.Environment(), WorkerLog()
    for name, load_kg in (("ana", 0), ("ben", 30)):
        handling = {"bend": {"load_kg": load_kg, "grip": "good", "force": "intermittent", "rapid": False}}
        env.process(times(1)(Worker(env, name, {"bend": Bending()}, log=log, handling=handling), []))
    env.run()
    seen = exposure_of(log)
    assert seen.value("reba_mean", "ben") > seen.value("reba_mean", "ana")
    with pytest.raises(ValueError, match="worker ana: handling of bend: grip: no 'fiar'"):
        Worker(env, "ana", {"bend": Bending()}, handling={"bend": {"grip": "fiar"}})


def test_a_log_of_no_time_has_nothing_in_it():
    ana = Worker(simpy.Environment(), "ana", {"bend": Bending()})
    seen = exposure_of(ana.log)
    assert seen.minutes() == 0.0 and np.isnan(seen.value("rula_from_5_min_per_h", "ana")) and "all" in str(seen)


def test_somebody_who_did_nothing_has_no_minutes():
    log, _, _ = worked(idle)
    assert exposure_of(log).minutes() == 0.0


@pytest.mark.parametrize("name", EXPOSURE)
def test_every_figure_of_exposure_can_be_asked_for(name):
    log, _, _ = worked(times(2))
    seen = exposure_of(log, handling={"bend": SAID}, figures=[name])
    wanted = {"exposure_by_station", "exposure_by_product"}
    assert name in wanted or name in {figure.kpi for figure in seen.figures}


# ------------------------------------------------------------------------------------------------------ reading, errors
def test_it_reads_as_a_table_of_workers_and_tasks():
    log, _, _ = worked(times(2), names=("ben", "ana"))
    seen = exposure_of(log)
    head, *lines = str(seen).splitlines()
    assert head.split()[:4] == ["worker", "task", "minutes", "unknown"]
    assert [line.split()[0] for line in lines[:3]] == ["ana", "ben", "all"] and "a-b" in lines[-1]
    html = seen._repr_html_()
    assert html.count("<tr>") == 4 and "RULA 5+" in html and "0.6 min" in repr(seen)


def test_the_worst_posture_is_the_deepest():
    log, _, _ = worked(times(2), {"bend": Bending(kind=Bends)})
    (worst,) = exposure_of(log, handling={"bend": SAID}).worst()
    assert (worst.worker, worst.task, worst.load_kg) == ("ana", "bend", 6.0)
    assert worst.progress == pytest.approx(0.5, abs=0.01) and worst.joints_m.shape[1] == 3


def refused(*did, **how):
    with pytest.raises((TypeError, ValueError)) as caught:
        exposure_of(*did, **how)
    return str(caught.value)


def test_what_makes_no_sense_is_said():
    log, done, (ana,) = worked(times(2))
    rows = log.close()
    assert "workers=[...]" in refused(rows)
    assert "no worker 'ana'" in refused(rows, [Worker(simpy.Environment(), "anna", {"bend": Bending()})])
    assert "no task 'bend'; did you mean 'bent'?" in refused(rows, [Worker(ana.env, "ana", {"bent": Fixed(1.0)})])
    assert "is of replication 2" in refused(rows, [Worker(ana.env, "ana", {"bend": Bending()}, replication=2)])
    assert "is a piece given twice?" in refused([*done, done[0]])
    assert "found 3" in refused([3]) and "found 3" in refused(3) and "expected Workers" in refused(rows, [3])
    assert "no workers" in refused([]) and "no workers" in refused(WorkerLog())
    assert "did you mean 'rula_mean'?" in refused(log, figures=["rula_men"])
    assert "from_s: found 20" in refused(log, from_s=20.0)
    assert "rate_hz" in refused(log, options=Options(rate_hz=100.0))
    assert "from_s: found 'noon'" in refused(log, from_s="noon")
    assert "a Worker; give its worker.log" in refused(ana)
    with pytest.raises(ValueError, match="no level 'rula_from_6'"):
        exposure_of(log).minutes("rula_from_6")
    with pytest.raises(ValueError, match="no task 'bed'; did you mean 'bend'"):
        exposure_of(log).minutes(task="bed")
    seen = exposure_of(log)
    for words, said in (
        (("rula_mean", "ben"), "rula_mean: no subject 'ben'; there are: '', ana"),
        (("rula_men",), "no figure 'rula_men'; did you mean 'rula_mean'"),
        (("lifting_index", "ana"), "was made: ask for it, exposure_of.*figures=.'lifting_index'"),
        (("rula_mean", "ana", "at_mst"), "no part 'at_mst'; did you mean 'at_most'"),
    ):
        with pytest.raises(KeyError, match=said):
            seen.value(*words)


def test_pieces_of_two_runs_are_refused():
    _, one, _ = worked(times(1), seed=1)
    _, other, _ = worked(times(1), seed=2)
    later = [replace(piece, start_s=50.0, end_s=59.0) for piece in other]
    assert "two workers, or runs, of one name" in refused([*one, *later])
    _, third, _ = worked(times(1), names=("ben",), replication=1)
    assert "several replications: 0, 1" in refused([*one, *third])
    bare = replace(one[0], drawn=replace(one[0].drawn, luck=None))
    assert "no Worker performed this" in refused(bare)


FLOOR = """
opsim: 1
name: floor
run: {horizon: 2 h, warm_up: 1 h, seed: 4}
layout: {places: {a: [0 m, 0 m], b: [6 m, 0 m], c: [6 m, 0.2 m]}}
tasks: {bend: {fixed: 9 s}, glue: {dist: exponential, mean: 8 s}}
stations: {s1: {at: a, tasks: [bend], buffer: 1}, s2: {at: b, tasks: [glue], buffer: 1}}
products: {p: {route: [s1, s2]}}
release: {kind: saturated}
workers: {ana: {walk: 1 m/s, skills: {s1: 1.0, s2: 1.0}}, ben: {walk: 2 m/s, skills: {s1: 1.0, s2: 1.0}}}
"""
HOUR_S = 3600.0
TRUNK = ("trunk_beyond_60_min_per_h", "trunk_beyond_20_min_per_h", "trunk_flexion_mean_deg", "trunk_flexion_p95_deg")


class Leans(Walk):
    """Everybody leans by 25 degrees."""

    def sample(self, n, rng, **how):
        drawn = super().sample(n, rng, **how)
        return type(drawn)(drawn.distance_m, drawn.duration_s, drawn.n_steps, np.full(n, 25.5))


def floor():
    found = plan_of_posture_walking(FLOOR)
    found = replace(found, tasks=(replace(found.tasks[0], model=Bending()), found.tasks[1]))
    return walking(found, Leans())


def values(rows, of):
    return {(f.kpi, f.subject, f.part): f.value for f in figures(made(rows, of), of, POSTURE) if f.kpi in POSTURE}


def bend(at, worker=0, k=0):
    return work(at, at + 9, 0, worker=worker, k=k)


def walk(at, worker=0, places=(0, 1), seconds=6):
    return row(WALK, at, at + seconds, worker=worker, places=places)


@pytest.fixture(scope="module")
def by_hand():
    """In an hour ana bends 10 times for 9 s and walks 20 times 6 m in 6 s, and once 0.2 m; ben walks once, in 3 s."""
    rows = [bend(HOUR_S + 100 * k, k=k) for k in range(10)]
    rows += [walk(HOUR_S + 50 + 100 * k) for k in range(20)] + [walk(HOUR_S + 3000, places=(1, 2), seconds=0.2)]
    return values([*rows, walk(HOUR_S + 1, 1, seconds=3)], floor())


@pytest.mark.parametrize(
    ("kpi", "subject", "part", "expected"),
    [
        ("walking_min_per_h", "ana", "", 2),
        ("walking_min_per_h", "ben", "", 3 / 60),
        ("walking_min_per_h", "", "", (2 + 3 / 60) / 2),
        ("steps_per_h", "ana", "", 20 * 12),
        ("step_length_m", "ana", "", 0.5),
        ("step_length_m", "ben", "", 0.6),
        ("step_length_m", "", "", 126 / 250),
        ("cadence_per_min", "ana", "", 120),
        ("trunk_beyond_20_min_per_h", "ana", "", 70 / 60),
        ("trunk_beyond_20_min_per_h", "ana", "walking", 2),
        ("trunk_beyond_20_min_per_h", "ana", "together", 2 + 70 / 60),
        ("trunk_beyond_60_min_per_h", "ana", "walking", 0),
        ("trunk_beyond_60_min_per_h", "ben", "together", 0),
        ("trunk_flexion_mean_deg", "ana", "", 45),
        ("trunk_flexion_mean_deg", "ana", "walking", 25.5),
        ("trunk_flexion_mean_deg", "ana", "together", (45 * 90 + 25.5 * 120) / 210),
        ("trunk_flexion_p95_deg", "ben", "walking", 25.95),
        ("trunk_flexion_share", "ana", "below_20", 20 / 3600),
        ("trunk_flexion_share", "ana", "walking_from_20", 120 / 3600),
        ("trunk_flexion_share", "ana", "walking_below_20", 0),
        ("trunk_flexion_share", "ana", "walking_unmeasured", 0.2 / 3600),
        ("trunk_flexion_share", "ana", "waits", 1 - 210.2 / 3600),
        ("posture_measured_share", "ana", "", 1),
        ("walking_measured_share", "ana", "", 120 / 120.2),
        ("walking_measured_share", "", "", 123 / 123.2),
    ],
)
def test_a_figure_is_what_the_hand_finds(by_hand, kpi, subject, part, expected):
    assert by_hand[kpi, subject, part] == pytest.approx(expected, rel=0.005, abs=1e-9)


def test_shares_of_the_window_sum_to_one(by_hand):
    for subject in ("", "ana", "ben"):
        shares = [value for (kpi, of, _), value in by_hand.items() if (kpi, of) == ("trunk_flexion_share", subject)]
        assert len(shares) == 8 and sum(shares) == pytest.approx(1, abs=1e-12)


def test_who_does_not_walk_takes_no_steps_and_has_no_step_length():
    found = values([bend(HOUR_S)], floor())
    assert found["walking_min_per_h", "ana", ""] == found["steps_per_h", "ana", ""] == 0
    assert np.isnan(found["step_length_m", "ana", ""]) and np.isnan(found["cadence_per_min", "ana", ""])
    assert found["trunk_beyond_20_min_per_h", "ana", "walking"] == 0
    assert np.isnan(found["trunk_flexion_mean_deg", "ana", "walking"])


def test_figures_of_work_are_those_without_walking():
    """The same names mean the same, and only parts and names of walking are new."""
    of = replace(floor(), horizon_s=4200.0)
    log = run_plan_of_posture_walking(of)
    with_it = {f[:3]: f.value for f in figures(log, of, POSTURE)}
    without = {f[:3]: f.value for f in figures(log, replace(of, walking=None), POSTURE)}
    same = without.keys() & with_it.keys()
    assert all(np.array_equal(with_it[key], without[key], equal_nan=True) for key in same)
    assert {key[2] for key in without.keys() - same} == {"not_at_work"}
    new = with_it.keys() - same
    assert {key[0] for key in new} <= {*WALKING, *TRUNK, "trunk_flexion_share"}
    assert not any(kpi in WALKING for kpi, *_ in without)


def test_walking_minutes_are_the_share_of_time_that_workers_walk():
    of = walking(plan_of_posture_walking(FLOOR.replace(", ben: {walk: 2 m/s, skills: {s1: 1.0, s2: 1.0}}", "")))
    found = {f[:3]: f.value for f in figures(run_plan_of_posture_walking(of), of, POSTURE)}
    share = found["worker_states", "ana", "walk"]
    assert found["walking_min_per_h", "ana", ""] == pytest.approx(60 * share, rel=1e-9) and share > 0.05
    metres = found["steps_per_h", "ana", ""] * found["step_length_m", "ana", ""]
    assert metres == pytest.approx(found["walked_m", "ana", ""], rel=1e-6)


def test_who_walks_faster_walks_less_long_and_with_longer_steps(by_hand):
    assert by_hand["step_length_m", "ben", ""] > by_hand["step_length_m", "ana", ""]


def test_how_much_walking_was_measured_stands_beside_what_was_asked_of_it():
    assert headline(["steps_per_h"]) == {"steps_per_h", "walking_measured_share", "posture_measured_share"}
    assert "walking_measured_share" not in headline(["trunk_flexion_mean_deg"])

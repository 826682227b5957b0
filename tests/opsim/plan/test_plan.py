"""Who works in which replication.

Stops of stations as a Plan has them: natural order, a task each, models of what counts and of what is done.

Quality and tools as numbers: where rework goes back to, detours, marks as moments.

Stretches in metres become times on the line's clock; a station of a line has the room that the line gives it.

Skeletons that lack joints: which scores remain is said, of the tasks whose they are.

Workers of a plan: their bodies reach the models, and what nobody reads is said.
"""

from dataclasses import replace
from math import inf
from types import SimpleNamespace

import numpy as np
import plans
import pytest
from plans import CELL, HERE, loaded, plan

from opsim.engine.floor.run import run_plan
from opsim.ergonomics.angles import CANONICAL
from opsim.ergonomics.redraw import drawn_again, pieces_in_window
from opsim.log import WORK
from opsim.plan import Plan, compile_plan
from opsim.plan.loads import station_loads
from opsim.plan.warnings import hour_risks
from opsim.scenario.read import scenarios_in
from opsim.subjects.breakdowns.plan import NO_TEAM
from opsim.subjects.quality.plan import NOWHERE
from opsim.subjects.tasks.model import UniformCount
from opsim.subjects.tasks.warnings import lacking, unread, unseen
from opsim.subjects.tools.plan import Moment
from opsim.tasks import Exponential, Fixed, Geometric


def staffed(how):
    return plan(CELL.replace("seed: 5", f"seed: 5, staffing: {how}"))


def test_the_same_people_work_in_every_replication_unless_they_are_redrawn():
    assert [staffed("fixed").workforce_of(r) for r in range(3)] == [0, 0, 0]
    assert [staffed("redrawn").workforce_of(r) for r in range(3)] == [0, 1, 2]


@pytest.mark.parametrize("how", ["fixed", "redrawn"])
def test_engine_and_exposure_ask_the_plan_who_works(how, monkeypatch):
    p = staffed(how)
    as_ever = run_plan(p, 1)
    monkeypatch.setattr(Plan, "workforce_of", lambda _plan, _replication: 7)
    log = run_plan(p, 1)
    assert not np.array_equal(log["end_s"], as_ever["end_s"])
    for block, pieces in drawn_again(pieces_in_window(log, p), 1, p):
        whole = np.flatnonzero((pieces.progress_from == 0) & (pieces.progress_to == 1))
        rating = {r for r in p.workers[pieces.worker[0]].rating if r}
        for row in whole:
            assert _rated(block.duration_s[pieces.k[row] % 64], rating, pieces.seconds[row])


def _rated(duration_s, ratings, seconds):
    return any(abs(duration_s / rating - seconds) < 1e-5 for rating in ratings)


SHOP = """
opsim: 1
name: shop
run: {horizon: 8 h, variability: none}
layout: {places: {hall: [0 m, 0 m]}}
tasks: {press: {fixed: 10 s, automatic: true}}
stations:
  p10:
    at: hall
    tasks: [press]
    breakdowns: {wear: {every: {dist: uniform, low: 4, high: 9}, by: cycles, repair: {dist: exponential, mean: 1 min}}}
    maintenance: {oil: {every: 4 h, lasts: 9 min, team: b}}
  p2:
    at: hall
    tasks: [press]
    breakdowns:
      jam10: {every: {dist: geometric, mean: 50}, by: cycles, repair: {fixed: 1 min}, team: a10, job: scrap}
      jam9: {every: {dist: exponential, mean: 4 h}, by: busy, repair: {fixed: 2 min}, team: a9}
    maintenance: {clean: {every: 4 h, first: 1 h, lasts: {fixed: 7 min}, when: at_once}}
products: {part: {route: [p2, p10]}}
release: {kind: poisson, every: 1 min}
repair_teams: {b: {n: 3}, a10: {}, a9: {}}
"""
PLAN = plan(SHOP)


def test_stops_stand_in_natural_order_each_with_its_station_team_and_task():
    found = [(one.name, one.station, one.team, PLAN.tasks[one.task].name) for one in PLAN.stops]
    assert found == [
        ("p2: jam9", 0, 0, "p2: jam9"),
        ("p2: jam10", 0, 1, "p2: jam10"),
        ("p10: wear", 1, NO_TEAM, "p10: wear"),
        ("p2: clean", 0, NO_TEAM, "p2: clean"),
        ("p10: oil", 1, 2, "p10: oil"),
    ]
    assert [(team.name, team.n) for team in PLAN.repair_teams] == [("a9", 1), ("a10", 1), ("b", 3)]


def test_what_counts_is_a_time_or_a_number_of_cycles():
    assert [(one.by, one.every) for one in PLAN.breakdowns] == [
        ("busy", Exponential(14400.0)),
        ("cycles", Geometric(50.0, 1.0)),
        ("cycles", UniformCount(4, 9)),
    ]
    assert [(one.first_s, one.every_s, one.after_job) for one in PLAN.maintenance] == [
        (3600.0, 14400.0, False),
        (14400.0, 14400.0, True),
    ]


def test_repairs_keep_their_luck_where_the_variability_of_tasks_is_switched_off():
    models = {task.name: task.model for task in PLAN.tasks}
    assert models["p10: wear"] == Exponential(60.0)
    assert [models[name] for name in ("p10: oil", "p2: clean")] == [Fixed(540.0), Fixed(420.0)]


def test_a_scenario_without_stops_has_none_in_its_plan():
    lines = [line for line in SHOP.split("\n") if not any(word in line for word in ("breakd", "maint", "jam", "teams"))]
    bare = plan("\n".join(lines))
    assert bare.stops == bare.repair_teams == ()
    assert [task.name for task in bare.tasks] == ["press"]


LINE = """
opsim: 1
name: line
run: {horizon: 100 s}
libraries: {work: libraries/bench_work.npz}
layout: {places: {a: [0 m, 0 m]}}
tools: {gun: {n: 2}, jig: {}}
tasks: {t: {fixed: 1 s}, bolt: {emulator: work/fasten, hold: {tool: gun, from: start, to: 0.9}, needs: {jig: 1}}}
stations:
  cut:   {at: a, tasks: [t], buffer: 1, yield: 0.9}
  drill: {at: a, tasks: [bolt], needs: {gun: 1}}
  look:  {at: a, tasks: [t], inspect: {finds: 0.8, then: {rework: REWORK}, most: 3}}
  bench: {at: a, tasks: [t], scrap: 0.25}
products:
  a: {share: 0.5, route: [cut, drill, cut, look]}
  b: {share: 0.5, route: [drill, look, bench]}
release: {kind: poisson, every: 9 s}
workers: {w: {skills: {cut: 1.0, drill: 1.0, look: 1.0, bench: 1.0}}}
"""


def planned(rework, *changes):
    text = LINE.replace("REWORK", rework)
    for old, new in changes:
        text = text.replace(old, new)
    return plan(text)


def of(p, station):
    rank = next(rank for rank, one in enumerate(p.stations) if one.name == station)
    return next(one for one in p.quality if one.station == rank)


def test_rework_goes_back_to_the_last_time_before():
    assert of(planned("drill"), "look").back == ((NOWHERE, NOWHERE, NOWHERE, 1), (NOWHERE, 0, NOWHERE))
    assert of(planned("cut"), "look").back[0] == (NOWHERE, NOWHERE, NOWHERE, 2)


def test_rework_at_the_inspecting_station_is_done_there_again():
    assert of(planned("look"), "look").back == ((NOWHERE, NOWHERE, NOWHERE, 3), (NOWHERE, 1, NOWHERE))


def test_rework_off_the_way_is_a_step_behind_the_last_that_leads_back():
    p = planned("bench", (", bench]}", "]}"))
    for product, looked in zip(p.products, (3, 1)):
        assert product.route[-1].name == "bench"
        assert product.onward[-1] == ((1.0, looked),)
        assert product.visits()[-1] == 0 and product.visits()[:-1] == pytest.approx([1] * (len(product.route) - 1))
    assert of(p, "look").back == ((NOWHERE, NOWHERE, NOWHERE, 4, NOWHERE), (NOWHERE, 2, NOWHERE))


def test_a_product_without_rework_has_no_step_more():
    assert [len(product.route) for product in planned("drill").products] == [4, 3]


def test_scrap_is_a_yield_and_a_perfect_inspection():
    bench = of(planned("drill"), "bench")
    assert (bench.yield_share, bench.inspects, bench.finds, bench.back, bench.most) == (0.75, True, 1.0, (), inf)


def test_stations_without_quality_have_no_plan_of_it():
    p = planned("drill")
    assert [p.stations[one.station].name for one in p.quality] == ["bench", "cut", "look"]


def test_tools_are_numbered_in_natural_order_and_marks_are_moments():
    p = planned("drill")
    assert [(tool.name, tool.n) for tool in p.tools] == [("gun", 2), ("jig", 1)]
    bolt = next(task for task in p.tasks if task.name == "bolt")
    assert bolt.needs == ((1, 1),)
    assert (bolt.hold.tool, bolt.hold.start, bolt.hold.end) == (0, Moment(mark=0), Moment(share=0.9))
    assert next(station for station in p.stations if station.name == "drill").needs == ((0, 1),)


TEXT = """
opsim: 1
name: line
run: {horizon: 1000 s}
layout: {places: {a: [0 m, 0 m]}}
tasks: {t: {fixed: 50 s}}
stations: {s1: {at: a, tasks: [t]}, s2: {at: a, tasks: [t]}, z: {at: a, tasks: [t]}}
lines:
  final:
    {kind: moving, length: 6 m, lengths: {s2: 9 m}, stations: [s1, s2], takt: 60 s, upstream: 2 m, drift: 1 m}
products: {x: {route: [s1, s2, z]}}
release: {kind: poisson, every: 100 s}
workers: {ana: {skills: {s1: 1.0, s2: 1.0, z: 1.0}}, joker: {skills: {s1: 1.0}}}
"""
INDEXED = TEXT.replace("moving, length: 6 m, lengths: {s2: 9 m},", "indexed,").replace(
    ", upstream: 2 m, drift: 1 m", ""
)


def test_without_a_speed_jobs_are_a_stretch_apart():
    (line,) = plan(TEXT).lines
    assert line.speed_m_per_s == pytest.approx(0.1)
    assert line.start_m == (0.0, 6.0)
    assert line.reach_s == (0.0, 40.0)
    assert line.limit_s == (70.0, 160.0)
    assert line.exit_s == 150.0
    assert (line.start_s(1), line.reach_m(1)) == (60.0, pytest.approx(4.0))


def test_stations_have_the_room_of_their_line_and_others_their_own():
    assert [station.buffer for station in plan(TEXT).stations] == [inf, inf, inf]
    indexed = plan(INDEXED)
    assert [station.buffer for station in indexed.stations] == [0, 0, inf]
    assert indexed.lines[0].start_m == ()


def test_lines_come_in_natural_order_and_their_floaters_by_rank():
    text = INDEXED.replace("  final:\n", "  l10: {kind: indexed, stations: [z], takt: 9 s}\n  l2:\n")
    p = plan(
        text.replace("takt: 60 s}", "takt: 60 s, unfinished: send_on, andon: {workers: [joker], at: 50 s, does: help}}")
    )
    assert [line.name for line in p.lines] == ["l2", "l10"]
    assert (p.lines[0].floaters, p.lines[0].call_s, p.lines[0].helps, p.lines[0].sends_on) == ((1,), 50.0, True, True)


def test_no_station_of_a_line_does_more_than_a_job_a_takt():
    for text in (TEXT, INDEXED):
        loads = {load.station: load for load in station_loads(plan(text))}
        assert loads["s1"].most_per_h == pytest.approx(60)
        assert loads["s1"].load == pytest.approx(0.6)
        assert loads["z"].most_per_h == pytest.approx(72)


def test_jobs_that_come_faster_than_takt_are_more_than_the_line_can_do():
    read = loaded(INDEXED.replace("every: 100 s", "every: 55 s"))
    loads = {load.station: load.load for load in station_loads(compile_plan(read))}
    assert loads["s1"] == pytest.approx(60 / 55)


def test_work_that_takes_longer_than_takt_is_told():
    assert any(
        "s1 does not keep the takt of line final" in risk
        for risk in hour_risks(plan(INDEXED.replace("fixed: 50 s", "fixed: 61 s")))
    )


UNSEEN_CELL = """
opsim: 1
name: joints
run: {horizon: 1 h}
libraries: {work: libraries/bench_work.npz}
layout: {places: {a: [0 m, 0 m]}}
tasks: {make: {emulator: work/fasten}, bake: {fixed: 9 s, automatic: true}, look: {fixed: 9 s}}
stations: {s1: {at: a, tasks: [make, look, bake]}}
products: {part: {route: [s1]}}
release: {kind: poisson, every: 50 s}
workers: {ana: {skills: {s1: 1}}}
"""


@pytest.fixture(scope="module")
def unseen_plan():
    return plans.plan(UNSEEN_CELL)


def without(unseen_plan, *gone):
    """The plan with bodies that lack some joints."""
    names = [joint for joint in CANONICAL if joint not in gone]
    model = SimpleNamespace(skeleton=SimpleNamespace(names=names))
    return replace(
        unseen_plan, tasks=tuple(replace(t, model=model) if t.name == "make" else t for t in unseen_plan.tasks)
    )


def test_whole_bodies_and_times_without_one_need_no_word(unseen_plan):
    assert list(unseen(unseen_plan, ["rula_mean"])) == []


def test_what_is_missing_is_said_with_the_scores_that_become_wider(unseen_plan):
    (head,) = unseen(without(unseen_plan, "head"), ["rula_mean"])
    assert head.startswith("make: no head: the neck is not known, so RULA and REBA are wider")
    (wrists,) = unseen(without(unseen_plan, "left_wrist", "right_wrist"), ["reba_p90"])
    assert wrists.startswith("make: no wrists: how far elbow and wrist are bent is not known")


def test_nobody_is_warned_of_scores_he_does_not_ask_for(unseen_plan):
    assert list(unseen(without(unseen_plan, "head"), ["walked_m"])) == []


def test_tasks_of_the_same_skeleton_share_a_sentence(unseen_plan):
    blind = without(unseen_plan, "head").tasks
    both = [task for task in blind if task.name == "make"] * 2
    assert list(lacking(both).values()) == [["make", "make"]]


WORKERS_CELL = """
opsim: 1
name: cell
run: {horizon: 30 min, seed: 5}
libraries: {moves: libraries/public_movements.npz}
layout: {places: {a: [0 m, 0 m]}}
tasks:
  squat: {emulator: moves/deep_squat}
  raise: {emulator: moves/shoulder_scaption}
  label: {dist: lognormal, mean: 12 s, cv: 0.3, between_share: 0.4}
stations: {low: {at: a, tasks: [squat], buffer: 2}, high: {at: a, tasks: [raise]}, desk: {at: a, tasks: [label]}}
products: {box: {route: [low, high, desk]}}
release: {kind: saturated}
workers:
  ana: {height: 1.62 m, mass: 58 kg, age: 41, sex: f, skills: {low: 1, high: 1, desk: 1}}
  ben: {skills: {desk: 1}}
overrides:
  quick: {workers.ana.pace: 1.25}
  person: {workers.ana.person: s05}
scenarios: {base: [], quick: [quick], person: [person]}
"""
PLANS = {name: compile_plan(one) for name, one in scenarios_in(WORKERS_CELL.encode(), HERE / "test.yaml").items()}


def durations(variant, task):
    p = PLANS[variant]
    work = run_plan(p).of(WORK)
    rows = (work["task"] == [one.name for one in p.tasks].index(task)) & (work["progress_to"] == 1)
    return work.duration_s[rows & (work["worker"] == 0)]


def test_all_that_is_known_of_a_body_is_in_the_plan():
    ana, ben = PLANS["quick"].workers
    assert (ana.body.height_m, ana.body.mass_kg, ana.body.age_years, ana.body.sex, ana.body.pace) == (
        1.62,
        58.0,
        41.0,
        "f",
        1.25,
    )
    assert ben.body.said == ()


def test_pace_changes_emulated_times_and_no_others():
    """A quarter faster than the typical person, whoever she was before: her mean is that of the model at this pace."""
    squat = next(task.model for task in PLANS["quick"].tasks if task.name == "squat")
    typical_s = squat.mean_duration_s(squat.new_worker())
    asked_s = squat.mean_duration_s(squat.draw_worker(np.random.default_rng(0), PLANS["quick"].workers[0].body))
    assert abs(asked_s / (typical_s / 1.25) - 1) < 0.02
    quick_s = durations("quick", "squat")
    assert abs(quick_s.mean() - asked_s) < 4 * quick_s.std() / quick_s.size**0.5
    n = min(durations(variant, "label").size for variant in ("base", "quick"))
    assert np.array_equal(durations("base", "label")[:n], durations("quick", "label")[:n])


def test_a_recorded_person_takes_his_own_time():
    squat = next(task.model for task in PLANS["person"].tasks if task.name == "squat")
    times_s = durations("person", "squat")
    assert abs(times_s.mean() - squat.mean_duration_s("s05")) < 4 * times_s.std() / times_s.size**0.5


def test_a_task_that_does_not_know_the_person_is_named():
    assert unread(PLANS["person"]) == [
        "raise was recorded without s05 (ana): there they move as people drawn from the population"
    ]
    assert unread(plan(WORKERS_CELL.replace("age: 41", "person: s03"))) == []


def test_a_pace_that_no_task_reads_is_said():
    says = "the pace of ben changes nothing: none of their tasks is emulated; rate them by their skills"
    (warning,) = unread(plan(WORKERS_CELL.replace("ben: {", "ben: {pace: 1.1, ")))
    assert warning.startswith(says)
    assert unread(PLANS["quick"]) == []


def test_workers_without_anything_said_are_no_warning():
    assert unread(plan(loaded_text())) == []


def loaded_text():
    return WORKERS_CELL.replace("height: 1.62 m, mass: 58 kg, age: 41, sex: f, ", "")


def test_an_age_is_years_with_or_without_the_word():
    ages = [loaded(WORKERS_CELL.replace("age: 41", f"age: {said}")).scenario.workers["ana"].age_years for said in AGES]
    assert ages == [41.0, 41.0, 1.0 * 41.5]


AGES = ("41", "41 years", "41.5")

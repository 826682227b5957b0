"""What the assumption sheet says of people: how they differ, and what is known of them.

What comes in by files: told on the assumption sheet, copied beside the results, part of what makes a run.

What the assumption sheet says of stops, and how the table of tasks names their repairs.

The assumption sheet says of paced lines what happens to what is not done, and no longer what does not hold there.

What the assumption sheet says of vehicles, belts and loads.
"""

import pytest
from plans import CELL, line, loaded, plan

from opsim.plan import compile_plan
from opsim.scenario import read_scenarios
from opsim.study import run_scenario as run_scenario_of_released
from opsim.study.assumptions import assumptions_of, flow, station_model, task_sources
from opsim.study.results_folder import OtherRun
from opsim.study.run import run_scenario
from opsim.subjects.breakdowns.checks import stopped
from opsim.subjects.lines.warnings import lines
from opsim.subjects.people.assumptions import people
from opsim.subjects.release.checks import released


def sheet(text):
    """topic -> everything said under it."""
    one = loaded(text)
    said = {}
    for topic, says in assumptions_of(one, compile_plan(one)):
        said[topic] = f"{said[topic]}; {says}" if topic in said else says
    return said


def with_variability(word):
    return CELL.replace("seed: 5", f"seed: 5, variability: {word}")


@pytest.mark.parametrize(
    ("word", "says"),
    [
        ("none", "none: a task takes the same time whoever does it"),
        ("within_only", "within_only: every worker has the same mean time"),
        ("between_only", "between_only: a worker takes the same time whenever he does a task"),
        (
            "shuffled",
            "shuffled: times are as they were drawn, each with the body of another performance of the same worker",
        ),
    ],
)
def test_a_switch_of_variability_is_said_first(word, says):
    said = sheet(with_variability(word))
    assert next(iter(said)) == "variability" and said["variability"].startswith(says)


def test_full_variability_is_no_assumption():
    assert "variability" not in sheet(with_variability("full"))


@pytest.mark.parametrize(("word", "differ"), [("full", True), ("between_only", True), ("within_only", False)])
def test_own_pace_is_said_where_people_differ_in_it(word, differ):
    assert ("a worker's own pace is drawn once" in sheet(with_variability(word))["workers"]) is differ


BODIES = """
opsim: 1
name: cell
run: {horizon: 30 min, seed: 5}
libraries: {moves: libraries/public_movements.npz}
layout: {places: {a: [0 m, 0 m]}}
tasks: {squat: {emulator: moves/deep_squat}, raise: {emulator: moves/shoulder_scaption}, label: {fixed: 3 s}}
stations: {low: {at: a, tasks: [squat], buffer: 2}, high: {at: a, tasks: [raise]}, desk: {at: a, tasks: [label]}}
products: {box: {route: [low, high, desk]}}
release: {kind: saturated}
workers:
  ana: {height: 1.62 m, pace: 1.1, skills: {low: 1, high: 1, desk: 1}}
  ben: {mass: 70 kg, age: 30, person: s05, skills: {low: 1, high: 1}}
"""


def test_what_a_body_changes_and_where_is_said():
    says = sheet(BODIES)["bodies"]
    assert "height of ana: bones are scaled to it in raise, squat, not in label" in says
    both = sheet(BODIES.replace("person: s05, skills: {low: 1, high: 1}", "pace: 1.2, skills: {desk: 1}"))["bodies"]
    assert "pace of ana: moving times" in both and "pace of ben: kept with the worker" in both
    assert "pace of ana: moving times of the typical person are divided by it in raise, squat" in says
    assert "mass, age: kept with the worker; no task there changes pace or posture with it" in says


@pytest.mark.parametrize(
    ("word", "says"), [("none", "its mean"), ("within_only", "his own spread about it"), ("between_only", None)]
)
def test_a_pace_that_is_asked_for_stays_under_every_switch_and_is_said(word, says):
    said = sheet(BODIES.replace("seed: 5", f"seed: 5, variability: {word}"))
    mean = "pace of ana: the mean of everybody's times is divided by it in raise, squat, not in label"
    assert (mean in said["bodies"]) is (says is not None)
    line = f"{says}; ana: divided by the pace asked for in tasks that read it; arrivals"
    assert line in said["variability"] if says else "pace" not in said["variability"]
    assert "pace" not in sheet(with_variability(word))["variability"]


def test_the_pace_of_a_recorded_person_is_said_to_be_of_his_own_times():
    says = sheet(BODIES.replace("person: s05", "person: s05, pace: 1.2"))["bodies"]
    assert "pace of ana, ben: moving times of the typical person, or of the recorded one who is named, are" in says


def test_bones_are_scaled_to_heights_whether_or_not_recordings_explain_by_height(monkeypatch):
    line = "height_m: asked 1.62, recorded 1.5 to 1.9, used 1.62 (as asked)"
    plain = sheet(BODIES)["bodies"]
    assert "bones are scaled to it in raise, squat, not in label" in plain and "explain them" not in plain
    one = loaded(BODIES)
    plan = compile_plan(one)
    squat = next(task.model for task in plan.tasks if task.name == "squat")
    monkeypatch.setattr(type(squat), "draw_worker", lambda model, *_, **__: Effect(line) if model is squat else None)
    says = next(said for topic, said in assumptions_of(one, plan) if said.startswith("height of ana"))
    assert says.startswith("height of ana: bones are scaled to it in raise, squat, not in label")
    assert says.endswith("; pace and posture change as the recordings explain them by it in squat")


def test_who_moves_as_a_recorded_person_is_said_and_where_not():
    says = sheet(BODIES)["workers"]
    assert "move as people who were recorded, in emulated tasks and in every replication: ben as s05" in says
    assert "not everybody in raise, where some move as people drawn from the population" in says
    assert "not everybody" not in sheet(BODIES.replace("s05", "s03"))["workers"]


def test_a_body_that_the_emulator_had_to_clamp_is_said(monkeypatch):
    line = "height_m: asked 1.62, recorded 1.7 to 1.9, used 1.7 (clamped)"
    one = loaded(BODIES)
    plan = compile_plan(one)
    for task in plan.tasks:
        if task.name == "squat":
            monkeypatch.setattr(type(task.model), "draw_worker", lambda *given, **more: Effect(line))
    says = [said for topic, said in assumptions_of(one, plan) if topic == "bodies"][-1]
    assert says.startswith("unlike the bodies that were recorded; what these explain is as with the nearest of them:")
    assert f"ana in squat: {line}" in says


def test_skill_levels_are_said_not_to_be_measured():
    text = BODIES.replace("workers:", "skill_levels: {learner: 0.8, expert: 1.15}\nworkers:").replace(
        "desk: 1}", "desk: expert}"
    )
    assert sheet(text)["skills"].endswith("the scenario's own, not measured: learner 0.8, expert 1.15")
    assert "skills" not in sheet(BODIES)


def test_workers_who_are_nobody_in_particular_are_said():
    says = sheet(BODIES + "workforce: {n: 3}\n")["workers"]
    assert "w1 to w3: nobody in particular, drawn from the population" in says
    assert "w1 to w3: skills not given; everybody can work at every station, with the rating 1" in says
    recorded = sheet(BODIES + "workforce: {n: 3, from: recorded, like: ana}\n")["workers"]
    assert "nobody in particular" not in recorded and "skills not given" not in recorded
    assert "ben as s05, w1 as s01, w2 as s02, w3 as s03" in recorded


class Effect:
    def __init__(self, line):
        self.said = (line, "mass_kg: asked 58, recorded 50 to 90, used 58 (as asked)")


def test_a_floor_that_locks_itself_is_said(tmp_path):
    text = line(2, 0, horizon="1000 s", warm_up="0 s").replace("route: [s1, s2]", "route: [s1, s2, s1]")
    result = run_scenario(loaded(text), folder=tmp_path / "r", processes=1, replications=2)
    (warning,) = result.summary["warnings"]
    assert warning.startswith("the floor locked itself in 2 of 2 replications")
    assert "job 1 (part) at s1 waits for a place at s2, job 0 (part) at s2 waits for a place at s1" in warning


def test_a_floor_that_moves_says_nothing(tmp_path):
    result = run_scenario(loaded(line(2, 0, horizon="1500 s")), folder=tmp_path / "r", processes=1, replications=2)
    assert result.summary["warnings"] == []


TEXT = """
opsim: 1
name: files
run: {horizon: 100 s, replications: 1}
layout: {places: {hall: [0 m, 0 m]}}
tasks: {t: {fixed: 1 s, automatic: true}}
stations: {s1: {at: hall, tasks: [t]}}
products: {a: {route: [s1]}, b: {route: [s1]}}
sources:
  plan: {kind: schedule, file: lists/orders.csv}
  mixed: {kind: renewal, every: {recorded: gaps.csv, by: trace}, sequence: mix.csv}
cards: {few: {n: 3, to: s1, products: a}}
"""


@pytest.fixture
def file(tmp_path):
    (tmp_path / "lists").mkdir()
    (tmp_path / "lists" / "orders.csv").write_text("time,product,quantity\n5,a,2\n200,b,1\n")
    (tmp_path / "gaps.csv").write_text("10\n20\n")
    (tmp_path / "mix.csv").write_text("product\nb\n")
    (tmp_path / "files.yaml").write_text(TEXT)
    return tmp_path / "files.yaml"


def test_files_go_along_so_that_the_resolved_scenario_runs_from_its_folder(file, tmp_path):
    out = tmp_path / "out"
    run_scenario_of_released(read_scenarios(file)["base"], folder=out, processes=1)
    for name in ("lists/orders.csv", "gaps.csv", "mix.csv"):
        assert (out / name).read_bytes() == (tmp_path / name).read_bytes()
    again = tmp_path / "again"
    run_scenario_of_released(read_scenarios(out / "scenario.resolved.yaml")["base"], folder=again, processes=1)
    rows = "events/replication_00000.parquet"
    assert (again / "kpis.parquet").read_bytes() == (out / "kpis.parquet").read_bytes()
    assert (again / rows).exists()


@pytest.mark.parametrize("name", ["lists/orders.csv", "gaps.csv", "mix.csv"])
def test_a_list_that_has_changed_is_another_run(name, file, tmp_path):
    run_scenario_of_released(read_scenarios(file)["base"], folder=tmp_path / "out", processes=1)
    changed = tmp_path / name
    changed.write_text(changed.read_text() + changed.read_text().splitlines()[-1] + "\n")
    with pytest.raises(OtherRun, match="has changed"):
        run_scenario_of_released(read_scenarios(file)["base"], folder=tmp_path / "out", processes=1)


def test_the_assumption_sheet_says_how_jobs_come_in_and_what_holds_them_back(file):
    said = dict(released(compile_plan(read_scenarios(file)["base"])))
    assert said["cards"] == "few: at most 3 jobs of a at once; a job gives its card back when it leaves s1, in no time"
    lines = [line for _, line in released(compile_plan(read_scenarios(file)["base"]))]
    late = "1 of its 2 orders come at the horizon or later"
    assert lines[1] == f"plan: 2 jobs come at the times of the file, none early or late; {late}"
    assert lines[0].startswith(
        "mixed: jobs come with gaps of their own distribution (renewal), one every 15 s on average"
    )


def test_due_dates_of_a_file_are_said_to_be_counted_from_the_start(file, tmp_path):
    (tmp_path / "lists" / "orders.csv").write_text("time,product,due\n5,a,60\n200,b,\n")
    lines = [line for _, line in station_model(compile_plan(read_scenarios(file)["base"]))]
    assert "plan: orders are due when their file says, counted from the start" in lines


STOPPED_TEXT = """
opsim: 1
name: shop
run: {horizon: 8 h}
layout: {places: {hall: [0 m, 0 m]}}
tasks: {press: {fixed: 10 s, automatic: true}}
stations: {m: {at: hall, tasks: [press], buffer: 1, STOPS}}
products: {part: {route: [m]}}
release: {kind: saturated}
repair_teams: {crew: {n: 1}}
"""
JAM = "breakdowns: {jam: {every: {fixed: 1 h}, repair: {dist: exponential, mean: 2 min}, MORE}}"
OIL = "maintenance: {oil: {every: 2 h, lasts: 9 min}}"


def made(stops):
    one = loaded(STOPPED_TEXT.replace("STOPS", stops))
    return one, compile_plan(one)


@pytest.mark.parametrize(("more", "words"), [
    ("by: clock", "m: jam: what leads to it counts while the station is up, in work or not"),
    ("by: busy", "m: jam: what leads to it counts only while something is done there"),
    ("job: scrap", "m: jam: what was in work is scrap"),
    ("job: restart", "m: jam: what was in work begins anew, with a time of its own"),
    ("by: busy", "m: jam: ends by itself after its time; no worker and no team is needed"),
])  # fmt: skip
def test_what_is_assumed_of_a_breakdown_is_told(more, words):
    assert words in [said for _, said in stopped(made(JAM.replace("MORE", more))[1])]


def test_nothing_is_told_of_a_team_that_comes_as_one_that_need_not():
    told = [said for _, said in stopped(made(JAM.replace("MORE", "team: crew"))[1])]
    assert not any("ends by itself" in said for said in told)
    assert any("a repair team comes without a walk" in said for said in told)


def test_repairs_stand_among_the_times_with_their_station_and_words():
    rows = {row["task"]: row for row in task_sources(*made(f"{JAM.replace('MORE', 'job: resume')}, {OIL}"))}
    assert list(rows) == ["m: jam", "m: oil", "press"]
    assert [rows[name]["model"] for name in ("m: jam", "m: oil")] == ["exponential, mean 120 s", "fixed, 540 s"]
    assert [rows[name]["station"] for name in rows] == ["m", "m", "m"]
    assert rows["m: jam"]["mean_s"] == 120


LINES_TEXT = """
opsim: 1
name: line
run: {horizon: 1000 s}
layout: {places: {a: [0 m, 0 m]}}
tasks: {t: {fixed: 50 s}}
stations: {s1: {at: a, tasks: [t]}, s2: {at: a, tasks: [t]}}
lines: {final: {kind: indexed, stations: [s1, s2], takt: 60 s, andon: {workers: [joker], at: 50 s}}}
products: {x: {route: [s1, s2]}}
release: {kind: saturated}
workers: {ana: {skills: {s1: 1.0, s2: 1.0}}, joker: {skills: {s1: 1.0}}}
"""
MOVING = LINES_TEXT.replace("indexed,", "moving, length: 6 m, unfinished: send_on,").replace(
    "at: 50 s}}", "at: 50 s, does: help}}"
)


def test_a_line_that_stops_and_one_that_sends_on_are_told_apart():
    assert any("the line stands and all other work goes on" in said for _, said in lines(plan(LINES_TEXT)))
    assert any("goes on as it is and is bad" in said for _, said in lines(plan(MOVING)))


def test_how_it_moves_and_who_is_called_are_told():
    assert any("moving on takes no time" in said for _, said in lines(plan(LINES_TEXT)))
    assert any("the line moves 0.1 m/s" in said for _, said in lines(plan(MOVING)))
    assert any(
        said.startswith("final: joker only when called; who comes takes a time") for _, said in lines(plan(LINES_TEXT))
    )
    assert any("takes his own share of what is left" in said for _, said in lines(plan(MOVING)))


def test_jobs_on_a_line_do_not_pass_without_time_and_no_buffer_in_front_is_unlimited():
    said = " ".join(text for _, text in flow(loaded(MOVING), plan(MOVING)))
    assert "without time" not in said.replace("moving on takes no time", "")
    assert "unlimited" not in said


def test_people_on_a_moving_line_walk_at_a_speed_that_is_told():
    def told(text):
        read = loaded(text)
        return " ".join(said for _, said in people(read, compile_plan(read)))

    assert "ana, joker: walking speed not given" in told(MOVING).replace(" and ", ", ")
    assert "walking speed" not in told(LINES_TEXT)


TRANSPORT_ASSUMPTIONS_TEXT = """
opsim: 1
name: moves
run: {horizon: 1 h, seed: 1}
layout: {places: {a: [0 m, 0 m], b: [6 m, 0 m], c: [9 m, 0 m]}}
tasks: {t: {fixed: 10 s}}
stations: {saw: {at: a, tasks: [t]}, drill: {at: b, tasks: [t]}, pack: {at: c, tasks: [t]}}
conveyors: {belt: {from: a, to: b, speed: 0.5 m/s, pitch: 1 m}}
transporters: {truck: {at: c, speed: 2 m/s, legs: [[drill, pack]]}}
products: {x: {route: [saw, belt, drill, pack], carried: true, mass: 8 kg}}
release: {kind: poisson, every: 60 s}
workers: {ana: {most_load: 9 kg, skills: {saw: 1.0}}, bo: {skills: {drill: 1.0, pack: 1.0}}}
"""


def said(text=TRANSPORT_ASSUMPTIONS_TEXT):
    one = loaded(text)
    return [words for topic, words in flow(one, compile_plan(one)) if topic == "transport"]


def test_vehicles_and_belts_say_what_is_left_out():
    lines = said()
    assert any(line.startswith("truck: drivers and batteries always there") for line in lines)
    assert any(line.startswith("truck: called when a job's next place is sure") for line in lines)
    assert any(line.startswith("belt: belts run all the time") for line in lines)


def test_who_has_a_load_limit_and_who_has_none_is_said():
    lines = said()
    assert "ana: as many walks as the load limit asks for, with whole pieces of x" in lines
    assert "bo: no load limit is given; they carry all of a job at once" in lines
    assert "x: no mass is given, and anybody carries all of a job at once" in said(
        TRANSPORT_ASSUMPTIONS_TEXT.replace(", mass: 8 kg", "")
    )


def test_nothing_is_said_of_loads_where_nobody_carries():
    assert not [
        line
        for line in said(TRANSPORT_ASSUMPTIONS_TEXT.replace(", carried: true", ""))
        if "load" in line or "carr" in line
    ]

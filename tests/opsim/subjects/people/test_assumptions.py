"""What the sheet says of who does what.

What the assumption sheet says of crews.

What the sheet says of job rotation.

What the sheet says of quality, tools, teams and attended runs.

Walking with postures on its way through a study: rows stay, figures come, the sheet says what stands behind.

What the assumption sheet says of hours.
"""

import json

import numpy as np
import pytest
from plans import loaded, plan

from opsim.log_parquet import read_events
from opsim.plan import compile_plan
from opsim.problems import ScenarioError
from opsim.scenario.read import scenarios_in
from opsim.study import run_scenario
from opsim.study.assumptions import assumptions_of, station_model
from opsim.subjects.lines.warnings import crews
from opsim.subjects.people.assumptions import assignment, qualities, rotations
from opsim.subjects.shifts.assumptions import working_time
from tests.opsim.made_walks import made_library

TEXT = """
opsim: 1
name: sheet
run: {horizon: 100 s}
layout: {places: {a: [0 m, 0 m]}}
tasks: {base: {fixed: 4 s}, lid: {fixed: 6 s}, seal: {fixed: 8 s}}
stations:
  front: {at: a, tasks: [base, lid], buffer: 1, priority: 2, share: {tasks: [lid], with: back}}
  back: {at: a, tasks: [seal], buffer: 2}
products: {part: {route: [front, back], priority: 1}}
release: {kind: saturated}
workers:
  ana: {zone: [front], patrol: [front], skills: {front: {pace: 1.0, quality: 0.9}, back: 1.0}}
  ben: {floater: true, patrol: [back], skills: {back: 1.0}}
allocation: {idle: patrol, serve: one, priorities: [products, stations]}
"""
PLAIN = TEXT.replace("zone: [front], ", "").replace("floater: true, ", "").replace(", priority: 2", "")
PLAIN = (
    PLAIN.replace(", share: {tasks: [lid], with: back}", "").replace(", priority: 1", "").replace(", serve: one", "")
)


def test_everything_that_decides_who_works_is_said():
    said = [says for _, says in assignment(plan(TEXT))]
    assert len(said) == 6
    assert said[0].endswith("nobody whose own it is, and no floater, is free: ana (front)")
    assert said[1] == "ben: sent only where nobody is free whose own station it is, but before others leave their zones"
    assert said[2].startswith("where jobs of a higher priority call")
    assert said[3].endswith("before the rule: front (2)")
    assert said[4].startswith(
        "lid: done at front where back has no free server and at least half of its buffer is taken"
    )
    assert "one operation at a stop" in said[5]


def test_nothing_is_said_where_nothing_is_asked():
    assert not list(assignment(plan(PLAIN)))
    assert not list(qualities(plan(PLAIN.replace("{pace: 1.0, quality: 0.9}", "1.0"))))


def test_qualities_are_named_with_their_station():
    ((topic, says),) = qualities(plan(TEXT))
    assert topic == "quality" and "ana at front 0.9;" in says


CREWS_ASSUMPTIONS_TEXT = """
opsim: 1
name: crews
run: {horizon: 1 h}
layout: {places: {hall: [0 m, 0 m]}}
tasks: {t: {fixed: 10 s}}
stations: {a: {at: hall, tasks: [t], servers: 2}, b: {at: hall, tasks: [t]}, c: {at: hall, tasks: [t]}}
products: {bag: {route: [a, b, c]}}
release: {kind: poisson, every: 60 s}
workers: {ana: {skills: {a: 1, b: 1}}, ben: {skills: {a: 1, b: 1, c: 1}}, cem: {skills: {b: 1, c: 1}}}
crews: {row: {kind: bucket_brigade, stations: [a, b], workers: [ben, ana]}}
"""


def said(text=CREWS_ASSUMPTIONS_TEXT):
    read = loaded(text)
    return [line for _, line in crews(read, compile_plan(read))]


def test_the_order_the_way_and_skills_that_count_for_nothing_are_said():
    first, *others = said()
    assert first.startswith("row: ben, ana, in this order; who comes back takes over the job of the one before him")
    assert others == [
        "a: side by side somebody may be further in a task, nobody leaves out of turn",
        "cem: could work at stations of row as well, and never do: no members",
        "ben: could work elsewhere as well, and never do: members of row",
    ]


def test_a_rabbit_chase_goes_by_itself():
    assert (
        "everybody goes with his job to the end of the line"
        in said(CREWS_ASSUMPTIONS_TEXT.replace("bucket_brigade", "rabbit_chase"))[0]
    )


CELL = """
opsim: 1
name: cell
run: {horizon: 1 h}
layout: {places: {a: [0 m, 0 m]}}
tasks: {t: {fixed: 1 s}}
stations: {cut: {at: a, tasks: [t]}, pack: {at: a, tasks: [t]}}
products: {part: {route: [cut, pack]}}
release: {kind: poisson, every: 9 s}
workers: {v: {skills: {cut: 1.0, pack: 1}}, w: {like: v}}
rotations: {turn: {workers: [w, v], posts: [cut, pack], every: 2 h}}
"""


@pytest.mark.parametrize(
    ("when", "said"),
    [
        (
            "every: 2 h",
            "turn: w, v share 2 posts, and change every 2 h from the start of the run, work time or not, each",
        ),
        (
            "after: 50",
            "change when 50 operations were done at one of the posts, by whomever, each to the next post; what",
        ),
        (
            "rule: least_time",
            "after every operation at one of the posts, a post going to who was there for the shortest",
        ),
    ],
)
def test_the_sheet_says_when_people_change_posts_and_who_goes_where(when, said):
    ((topic, words),) = rotations(plan(CELL.replace("every: 2 h", when)))
    assert topic == "rotation" and said in words


def test_nothing_is_said_where_nobody_changes_posts():
    assert list(rotations(plan(CELL.replace("rotations:", "#")))) == []


LINE = """
opsim: 1
name: line
run: {horizon: 100 s}
layout: {places: {a: [0 m, 0 m]}}
tools: {gun: {}}
tasks: {t: {fixed: 1 s, needs: {gun: 1}}, run: {fixed: 3 s, automatic: attended}, lift: {fixed: 2 s, team: 2}}
stations:
  cut:  {at: a, tasks: [t, lift], yield: 0.9}
  look: {at: a, tasks: [run], inspect: {finds: 0.8, false_alarms: 0.02, then: {rework: cut}, most: 3}}
products: {part: {route: [cut, look]}}
release: {kind: poisson, every: 9 s}
workers: {v: {skills: {cut: 1.0}}, w: {skills: {cut: 1.0, look: 1.0}}}
"""


@pytest.mark.parametrize(
    "said",
    [
        "cut: 0.9 of its operations leave no defect, each by chance alone",
        "look: 0.8 of bad jobs is found to be bad, and 0.02 of good ones is held to be bad",
        "look: a job is reworked at most 3 times, then it is scrap; it is good then until an operation leaves a defect "
        "anew",
        "throughput counts good jobs only: one that leaves with a defect nobody found is not in it",
        "tools of a task are taken as its worker sets out, and put back when the work is broken off",
        "run: takes the station's time, whoever attends it and whatever his skill",
        "lift: nobody comes before all can, and the slowest ends it; each has his own time",
    ],
)
def test_the_sheet_says_what_is_assumed_of(said):
    assert said in [words for _, words in station_model(plan(LINE))]


WALKING_CELL = """
opsim: 1
name: walkers
run: {horizon: 30 min, warm_up: 5 min, replications: 2, seed: 2}
libraries: {made: made.npz}
walking: {emulator: made/walk}
layout: {places: {a: [0 m, 0 m], b: [5 m, 0 m]}}
tasks: {cut: {dist: exponential, mean: 6 s}}
stations: {s1: {at: a, tasks: [cut], buffer: 3}, s2: {at: b, tasks: [cut], buffer: 3}}
products: {p: {route: [s1, s2], carried: true}}
release: {kind: poisson, every: 30 s}
workers: {ana: {height: 1.6 m, walk: 1 m/s, skills: {s1: 1.0, s2: 1.0}}}
outputs: [walking_min_per_h, steps_per_h, trunk_flexion_share]
"""
WITHOUT = WALKING_CELL.replace("libraries: {made: made.npz}\nwalking: {emulator: made/walk}\n", "").replace(
    "walking_min_per_h, steps_per_h", "walked_m"
)


def read(text, folder):
    return scenarios_in(text.encode(), folder / "walkers.yaml")["base"]


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    folder = tmp_path_factory.mktemp("walkers")
    with pytest.MonkeyPatch.context() as patch:
        made_library(folder, patch)
        runs = {"on": WALKING_CELL, "off": WITHOUT}
        yield {name: run_scenario(read(text, folder), folder=folder / name, processes=1) for name, text in runs.items()}


def rows(result, kpi, part=""):
    return {row["subject"]: row for row in result.summary["kpis"] if (row["kpi"], row["part"]) == (kpi, part)}


def test_the_rows_are_the_same_with_and_without_postures(results):
    for on, off in zip(results["on"].events_files, results["off"].events_files):
        with_it, without = read_events(on), read_events(off)
        assert all(np.array_equal(with_it[name], without[name], equal_nan=True) for name in with_it.columns)


def test_figures_of_walking_have_means_and_intervals_and_stand_in_front(results):
    found = rows(results["on"], "walking_min_per_h")
    assert set(found) == {"", "ana"} and found["ana"]["headline"] and found["ana"]["n"] == 2
    state = rows(results["on"], "worker_states", "walk")["ana"]["mean"]
    assert found["ana"]["mean"] == pytest.approx(60 * state)
    assert not rows(results["off"], "walking_min_per_h")


def test_the_summary_names_what_stands_behind_the_walks(results):
    source = results["on"].summary["walking"]
    assert source["model"] == "emulator made/walk" and source["library"] == "made.npz" and source["n_workers"] == 3
    assert "walking" not in results["off"].summary


def test_the_assumption_sheet_says_how_people_walk(results):
    said = {name: json.dumps(result.summary["assumptions"]) for name, result in results.items()}
    assert "people walk as in made/walk (12 made repetitions of 3 made-up people" in said["on"]
    assert "people walk at 0.3 to 2.5 m/s" in said["on"] and "counts only as far as that" in said["on"]
    assert "a drawn walk is straight" in said["on"] and "height of ana: bones are scaled to it" in said["on"]
    assert "made/walk" not in said["off"] and "a drawn walk" not in said["off"]
    assert "waiting is not measured" in said["on"] and "walking and waiting are not measured" in said["off"]


def test_the_manifest_has_the_library_and_the_folder_its_copy(results):
    folder = results["on"].folder
    manifest = json.loads((folder / "manifest.json").read_text())
    assert manifest["libraries"]["made"]["file"] == "made.npz" and len(manifest["libraries"]["made"]["sha256"]) == 64
    assert (folder / "made.npz").is_file()


def test_the_resolved_scenario_runs_again_from_its_folder_alone(results, tmp_path):
    folder = results["on"].folder
    again = scenarios_in((folder / "scenario.resolved.yaml").read_bytes(), folder / "scenario.resolved.yaml")["base"]
    result = run_scenario(again, folder=tmp_path, processes=1)
    assert json.dumps(result.summary["kpis"]) == json.dumps(results["on"].summary["kpis"])


def test_the_report_shows_a_walk_of_the_run(results, tmp_path):
    from opsim.report import materials, write_report
    from opsim.report.sections.walking import walking_section as section
    from opsim.study.run import opened

    runs = {"on": opened(results["on"], read(WALKING_CELL, results["on"].folder))}
    runs["off"] = opened(results["off"], read(WITHOUT, results["off"].folder))
    of = dict(materials(runs, results))
    (walk,) = (block for block in section(of["on"]).blocks if block.kind == "picture")
    assert walk.caption.startswith("ana: 1.00 m/s, steps of 0.50 m, ") and "slide by at most 0.0 mm" in walk.caption
    page = write_report(of["on"], tmp_path / "report.html").path.read_text()
    assert 'id="walking"' in page and "12 made repetitions of 3 made-up people" in page
    assert section(of["off"]) is None


@pytest.mark.parametrize(
    ("edit", "said"),
    [
        (("walk: 1 m/s", "walk: 3 m/s"), "workers.ana.walk: people of 'made/walk' cannot walk at 3 m/s"),
        (("walk: 1 m/s", "walk: 0.1 m/s"), "they walk at 0.3 to 2.5 m/s"),
        (("made/walk", "made/lift"), "'lift' is not an emulator of walking"),
        (("made/walk", "made/lift"), "walking in it: walk"),
        (("made/walk", "made/crank"), "'crank' is not an emulator of walking"),
        (("made/walk", "made/wakl"), "no task 'wakl' in library 'made'"),
    ],
)
def test_what_the_emulator_cannot_do_is_said_before_the_run(tmp_path, monkeypatch, edit, said):
    made_library(tmp_path, monkeypatch)
    with pytest.raises(ScenarioError) as caught:
        read(WALKING_CELL.replace(*edit), tmp_path)
    assert said in str(caught.value) and "1 problem in" in str(caught.value)


def test_a_speed_that_nobody_says_is_checked_too(tmp_path, monkeypatch):
    made_library(tmp_path, monkeypatch)
    monkeypatch.setattr("opsim.subjects.tasks.checks.USUAL_M_PER_S", 2.6)
    with pytest.raises(ScenarioError, match=r"workers.ana.*cannot walk at 2\.6 m/s"):
        read(WALKING_CELL.replace("walk: 1 m/s, ", ""), tmp_path)


WORKING_TIME_TEXT = """
opsim: 1
name: hours
run: {start: Mon 06:00, horizon: 24 h}
layout: {places: {here: [0 m, 0 m]}}
shifts:
  day: {from: 06:00, to: 14:00, at_break: hand_over, breaks: {tea: {at: 08:00, lasts: 9 min}}}
  all: {from: 06:00, to: 22:00}
tasks: {t: {fixed: 10 s}}
stations: {a: {at: here, tasks: [t], buffer: 3}}
products: {p: {route: [a]}}
release: {kind: poisson, every: 1 min}
workers: {ana: {shift: day, skills: {a: 1.0}}, ben: {shift: day, skills: {a: 1.0}}}
"""


def working_time_said(*edits):
    text = WORKING_TIME_TEXT
    for old, new in edits:
        assert old in text
        text = text.replace(old, new)
    return list(working_time(plan(text)))


@pytest.mark.parametrize(
    ("edits", "topic", "words"),
    [
        ([], "absence", "nobody is ever absent"),
        ([("ana: {", "ana: {absence: 0.05, ")], "absence", "missed, each by chance alone and for all of it: ana 0.05;"),
        ([("ben: {shift: day, ", "ben: {")], "workers", "ben: without a shift, and so there all the time"),
        ([], "interruption", "at breaks and meetings of day: who has to go works on until somebody free has come"),
        ([], "interruption", "at the end of a shift of day: who has to go finishes the task under way first"),
        (
            [("fixed: 10 s", "fixed: 10 s, interruption: restart")],
            "interruption",
            "in t, whatever the shift says: who has to go stops at once, what was done is lost",
        ),
        ([], "breaks", "later and in full"),
        ([("to: 14:00", "to: 14:00, overtime: {most: 90 min}")], "overtime", "day: people stay for up to 1.5 h"),
        (
            [("buffer: 3", "buffer: 3, shift: all")],
            "hours",
            "a: closed by hours; as it closes, what was begun is finished",
        ),
        (
            [("buffer: 3", "buffer: 3, shift: all, at_close: resume")],
            "hours",
            "a: closed by hours; as it closes, what was begun rests",
        ),
        ([("1 min}", "1 min, shift: all}")], "hours", "release: jobs come in its hours alone"),
        (
            [("1 min}", "1 min, shift: all}")],
            "hours",
            "throughput per hour counts the 8 scheduled hours of the window: while at least one station on a route may",
        ),
        ([("ben: {shift: day", "ben: {shift: all")], "hours", "throughput per hour counts the 16 scheduled hours"),
        ([], "hours", "hours of sources do not count"),
    ],
)
def test_what_is_assumed_of_hours_is_told(edits, topic, words):
    assert any(about == topic and words in text for about, text in working_time_said(*edits))


def test_rules_of_shifts_that_nobody_works_in_are_not_told():
    assert not any("all" in text.split(":")[0] for topic, text in working_time_said() if topic == "interruption")


def test_without_breaks_nothing_is_said_of_them():
    found = working_time_said((", at_break: hand_over, breaks: {tea: {at: 08:00, lasts: 9 min}}", ""))
    assert not any(topic == "breaks" or "at breaks" in text for topic, text in found)


def test_without_hours_everybody_is_there_all_the_time():
    (line,) = working_time_said(("shift: day, ", ""))
    assert line[1].startswith("everybody is present and equally fresh all the time")


def test_the_sheet_of_a_run_has_these_lines():
    one = loaded(WORKING_TIME_TEXT)
    sheet = assumptions_of(one, compile_plan(one))
    assert set(working_time(compile_plan(one))) <= set(sheet)


def test_hours_of_stations_are_told_where_nobody_works():
    text = WORKING_TIME_TEXT[: WORKING_TIME_TEXT.index("workers:")].replace(
        "fixed: 10 s", "fixed: 10 s, automatic: true"
    )
    one = loaded(text.replace("buffer: 3", "buffer: 3, shift: all"))
    sheet = assumptions_of(one, compile_plan(one))
    assert any(topic == "hours" and words.startswith("a: closed by hours") for topic, words in sheet)
    assert not any("everybody is present" in words for _, words in sheet)

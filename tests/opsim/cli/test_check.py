"""``opsim doctor engines``, with a stand-in for the fast engine that may be wrong.

Mistakes in the flow of material: ``check`` and ``run`` refuse them alike, each with its place and a remedy.
"""

import json
import time

import numpy as np
import pytest
from plans import many_stations
from stand_in_engine import spoilt, stand_in

from opsim import checkup
from opsim.engine.endless import EndlessInstant
from opsim.log import WORK
from opsim.scenario.json_schema import json_schema, schema_text
from opsim.shipped import shipped_scenarios
from tests.opsim.cli.calls import LINE, line, opsim


def test_check_shows_the_load_of_each_station(tmp_path):
    code, shown, _ = opsim("check", line(tmp_path))
    assert code == 0
    assert "press" in shown and "25.0 s" in shown and "144.0" in shown and "no problems found" in shown


def test_check_as_json_is_json(tmp_path):
    code, shown, _ = opsim("check", line(tmp_path), "--json")
    loads = json.loads(shown)["variants"]["base"]
    assert code == 0 and [load["station"] for load in loads] == ["press", "saw"]


def test_an_overloaded_station_is_warned_of(tmp_path):
    text = LINE.replace("kind: saturated", "kind: poisson, every: 10 s")
    code, _, complaint = opsim("check", line(tmp_path, text))
    assert code == 0 and "press cannot keep up: it would need 250% of its time" in complaint


def test_all_problems_are_said_at_once_with_their_place(tmp_path):
    text = LINE.replace("fixed: 25 s", "fixed: 25").replace("route: [saw, press]", "route: [saw, pres]")
    code, shown, complaint = opsim("check", line(tmp_path, text))
    assert (code, shown) == (2, "")
    assert "line.yaml:8:18:" in complaint and "did you mean 'press'?" in complaint and "2 problems in" in complaint


def test_check_and_run_complain_alike(tmp_path):
    path = line(tmp_path, "opsim: 1\n")
    assert opsim("check", path) == opsim("run", path, "-o", tmp_path / "out")
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("what", ["missing.yaml", "."])
def test_a_file_that_is_none_is_a_mistake(tmp_path, monkeypatch, what):
    monkeypatch.chdir(tmp_path)
    code, _, complaint = opsim("check", what)
    assert code == 2 and complaint.startswith(what)


def test_an_unknown_variant_gets_the_nearest_word(tmp_path):
    code, _, complaint = opsim("check", line(tmp_path), "--scenario", "bace")
    assert code == 2 and "base" in complaint


def test_a_shipped_scenario_is_known_by_name():
    assert opsim("check", "serial_line")[0] == 0


def test_a_route_that_may_lock_is_warned_of(tmp_path):
    path = line(tmp_path, LINE.replace("route: [saw, press]", "route: [saw, press, saw]"))
    code, _, complaint = opsim("check", path)
    assert code == 0 and "warning: base: press and saw send jobs round in a circle" in complaint
    assert "send jobs round" in json.loads(opsim("check", path, "--json")[1])["warnings"]["base"][0]


def test_a_file_of_4000_lines_is_checked_before_it_costs_much(tmp_path):
    text = many_stations(500)
    assert len(text.splitlines()) > 4000
    path = line(tmp_path, text)
    start = time.process_time()
    code, shown, _ = opsim("check", path)
    assert time.process_time() - start < 5  # a square law would take minutes; the benchmark asks for 1 s
    assert code == 0 and "no problems found in variants base, wide" in shown


def test_of_many_stations_the_busiest_are_shown(tmp_path):
    _, shown, _ = opsim("check", line(tmp_path, many_stations(80)))
    assert "the 30 busiest of 80 stations are shown" in shown
    assert " s19 " in shown and " s20 " not in shown


def test_people_what_is_shared_and_the_bottleneck_are_shown(tmp_path):
    code, shown, _ = opsim("check", "pump_plant", "--scenario", "base")
    assert code == 0 and "load of the skills" in shown and "shared as evenly as can be" in shown
    assert "load of what is shared" in shown and "forklift" in shown and "repair team" in shown
    assert "bottleneck by mean times:" in shown and "set-up" in shown and "no problems found" in shown


def test_loads_of_everything_are_in_the_json():
    said = json.loads(opsim("check", "pump_plant", "--scenario", "base", "--json")[1])
    assert {one["name"] for one in said["shared"]["base"]} >= {"torque_gun", "forklift", "mechanics", "small"}
    people = said["people"]["base"]
    assert people["skills"][0]["skill"] == "balancing" and set(people["together"]["workers"]) <= {"adam", "bea"}
    limits = [one["most_per_h"] for one in said["bottleneck"]["base"]]
    assert limits == sorted(limits)


HOURS = """
opsim: 1
name: Hours
run: {start: Mon 06:00, horizon: 8 h}
layout: {places: {here: [0 m, 0 m]}}
shifts: {early: {from: 06:00, to: 14:00, breaks: {lunch: {at: 10:00, lasts: 30 min}}}, night: {from: 22:00, to: 06:00}}
tasks: {hand: {fixed: 36 s}}
stations: {pack: {at: here, tasks: [hand], shift: night}, cut: {at: here, tasks: [hand]}}
products: {a: {route: [cut, pack]}}
release: {kind: poisson, every: 72 s}
workers: {ana: {shift: early, absence: 0.1, skills: {pack: 1, cut: 1}}}
"""


def test_hours_of_stations_and_people_are_shown_where_there_are_some(tmp_path):
    """Ana is there for 0.9 * 7.5 h of 8; pack is open when she is not."""
    code, shown, complaint = opsim("check", line(tmp_path, HOURS))
    assert code == 0 and " hours " in shown and "84.4%" in shown and "never there" in shown and "inf" not in shown
    assert "at work" in shown and "0.84" in shown
    assert "pack is never open in this run of 8 h" in complaint
    assert "ana cannot keep up: it takes 119% of the time" in complaint
    assert " hours " not in opsim("check", line(tmp_path))[1]


def test_hours_are_in_the_json(tmp_path):
    _, shown, _ = opsim("check", line(tmp_path, HOURS), "--json")
    cut, pack = json.loads(shown)["variants"]["base"]
    assert (cut["hours"], pack["hours"], pack["load"]) == (pytest.approx(0.84375), 0, None)


ONE_SHIFT = """
opsim: 1
name: hours
run: {start: Mon 06:00, horizon: 24 h, replications: 1}
layout: {places: {here: [0 m, 0 m]}}
shifts: {early: {from: 06:00, to: 14:00}}
tasks: {t: {fixed: 60 s}}
stations: {m: {at: here, tasks: [t], buffer: 1}}
products: {p: {route: [m]}}
release: {kind: saturated}
workers: {ana: {shift: early, skills: {m: 1.0}}}
"""


def test_where_hours_are_kept_check_says_of_which_hours_it_speaks_and_agrees_with_the_run(tmp_path):
    code, shown, _ = opsim("check", line(tmp_path, ONE_SHIFT))
    said = " ".join(shown.split())
    assert code == 0 and "ana (at most 60.0 jobs per scheduled hour, 20.0 per hour of the run)" in said
    assert "per h: of the run, for 33.3% of which the floor is scheduled to be open" in said
    code, shown, _ = opsim("run", line(tmp_path, ONE_SHIFT), "-o", tmp_path / "out")
    assert code == 0 and "Throughput (good units), per scheduled hour" in shown and "60.00 per hour" in shown
    limits = json.loads(opsim("check", line(tmp_path, ONE_SHIFT), "--json")[1])
    assert limits["bottleneck"]["base"][0]["most_per_scheduled_h"] == pytest.approx(60)
    assert limits["scheduled_share"] == {"base": pytest.approx(1 / 3)}


def test_without_hours_check_speaks_of_hours_alone(tmp_path):
    code, shown, _ = opsim("check", line(tmp_path))
    assert code == 0 and "jobs per h at most" in shown and "scheduled" not in shown


def test_effects_that_are_on_and_that_loads_know_nothing_of_are_named(tmp_path):
    human = "human: {learning: {model: wright}, fatigue: {model: lffrm}, rest: {above: 0.5, until: 0.2}}\n"
    code, shown, _ = opsim("check", line(tmp_path, ONE_SHIFT + human))
    assert code == 0 and "bottleneck are without learning, fatigue and rest by need (on under" in shown
    assert "bottleneck are without" not in opsim("check", line(tmp_path, ONE_SHIFT))[1]


def test_all_is_well_here():
    code, shown, _ = opsim("doctor")
    assert code == 0 and shown.endswith("all well\n")


def test_what_is_wrong_is_named_and_the_exit_code_is_2(monkeypatch):
    monkeypatch.setattr(checkup, "findings", lambda: [checkup.Finding("numpy", checkup.WRONG, "not installed")])
    code, shown, _ = opsim("doctor")
    assert code == 2 and "not installed" in shown and shown.endswith("wrong: numpy\n")
    code, shown, _ = opsim("doctor", "--json")
    assert code == 2 and json.loads(shown)["well"] is False


def test_a_note_is_nothing_wrong(monkeypatch):
    monkeypatch.setattr(checkup, "findings", lambda: [checkup.Finding("output", checkup.NOTE, "ascii")])
    assert opsim("doctor")[0] == 0


TWO = LINE + "\noverrides: {roomy: {stations.press.buffer: 5}}\nscenarios: {base: [], roomy: [roomy]}\n"


def late(log):
    """The end of a job's work is a last bit too late, in the second replication."""
    row = int(np.flatnonzero(log["kind"] == WORK)[20])
    return log if log.replication == 0 else spoilt(log, row, "end_s", np.nextafter(log["end_s"][row], np.inf))


def test_engines_that_agree_are_told_with_their_rows_and_times(tmp_path, monkeypatch):
    stand_in(monkeypatch)
    code, shown, said = opsim("doctor", "engines", line(tmp_path, TWO), "--replications", 2)
    assert code == 0 and shown.count("the same ") == 2 and "rows in 2 replications" in shown
    assert said.count("compiling") == 1 and not (tmp_path / "results").exists()


def test_the_numbers_are_there_for_machines(tmp_path, monkeypatch):
    stand_in(monkeypatch)
    code, shown, _ = opsim("doctor", "engines", line(tmp_path, TWO), "--scenario", "roomy", "--json")
    told = json.loads(shown)
    (variant,) = told["variants"]
    assert code == 0 and told["same"] and variant["variant"] == "roomy" and variant["rows"] > 100
    assert variant["simpy_s"] > 0 and variant["fast_s"] > 0 and "difference" not in variant


def test_a_last_bit_is_found_and_shown_column_by_column_with_the_rows_around(tmp_path, monkeypatch):
    stand_in(monkeypatch, spoil=late)
    assert opsim("doctor", "engines", line(tmp_path))[0] == 0
    code, shown, _ = opsim("doctor", "engines", line(tmp_path), "--replications", 3)
    assert code == 1 and "replication 1: row " in shown and "differs in end_s" in shown
    marked = [one.split() for one in shown.splitlines() if one.rstrip().endswith("differs")]
    assert [one[0] for one in marked] == ["end_s"] and marked[0][1] != marked[0][2]
    around = shown[shown.index("the rows around it") :]
    assert around.count("both ") == 3 and around.count("simpy ") == 4 and around.count("fast ") == 4


def test_a_difference_is_there_for_machines(tmp_path, monkeypatch):
    stand_in(monkeypatch, spoil=late)
    code, shown, _ = opsim("doctor", "engines", line(tmp_path), "--replications", 3, "--json")
    told = json.loads(shown)
    differ = told["variants"][0]["difference"]
    assert code == 1 and not told["same"] and told["variants"][0]["replications"] == 2
    assert (differ["replication"], differ["columns"]) == (1, ["end_s"])
    one, other = differ["row_by_simpy_and_fast"]["end_s"]
    assert np.nextafter(float(one), np.inf) == float(other)


def test_what_differs_in_one_variant_does_not_keep_the_others_from_being_told(tmp_path, monkeypatch):
    stand_in(monkeypatch, spoil=lambda log: spoilt(log, 3, "job", 99) if len(log) % 2 else log)
    _, shown, _ = opsim("doctor", "engines", line(tmp_path, TWO), "--json")
    assert [one["variant"] for one in json.loads(shown)["variants"]] == ["base", "roomy"]


def fails(error):
    """A log that is never written."""

    def fail(log):
        raise error

    return fail


def test_an_engine_that_alone_comes_to_no_end_is_told_as_a_difference(tmp_path, monkeypatch):
    stand_in(monkeypatch, spoil=lambda log: log if log.replication == 0 else fails(ZeroDivisionError("of mine"))(log))
    code, shown, complaint = opsim("doctor", "engines", line(tmp_path, TWO), "--replications", 3)
    assert code == 1 and "compiling" in complaint and shown.count("replication 1: simpy wrote ") == 2
    assert shown.count("rows, fast ended with ZeroDivisionError: of mine") == 2
    _, shown, _ = opsim("doctor", "engines", line(tmp_path), "--replications", 3, "--json")
    told = json.loads(shown)
    assert not told["same"] and told["variants"][0]["ended"].endswith("fast ended with ZeroDivisionError: of mine")


def test_what_neither_engine_comes_to_an_end_of_is_told_as_of_any_run(tmp_path, monkeypatch):
    def endless(*_):
        raise EndlessInstant("t = 60.0 s: over 10000 rounds")

    stand_in(monkeypatch).run_plan = endless
    monkeypatch.setattr("opsim.engine.floor.run.run_plan", endless)
    code, _, complaint = opsim("doctor", "engines", line(tmp_path))
    assert code == 1 and "does not move on in time" in complaint and "t = 60.0 s" in complaint


def test_the_first_run_on_a_new_floor_is_compared_too(tmp_path, monkeypatch):
    """As every first replication is one; the second is quicker, and timed."""
    runs = []
    stand_in(monkeypatch, spoil=lambda log: (runs.append(1), spoilt(log, 3, "job", 99) if len(runs) == 1 else log)[1])
    code, shown, _ = opsim("doctor", "engines", line(tmp_path))
    assert code == 1 and "row 3 differs in job" in shown and len(runs) == 2


def test_what_the_fast_engine_does_not_run_is_a_mistake(tmp_path, monkeypatch):
    stand_in(monkeypatch, refuses=["belts", "kits"])
    code, _, complaint = opsim("doctor", "engines", line(tmp_path))
    assert code == 2 and "belts" in complaint and "kits" in complaint
    assert "nothing to compare" in complaint and "--engine" not in complaint


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["no_such.yaml"], "no_such.yaml"),
        (["line.yaml", "--scenario", "bsae"], "no scenario 'bsae'"),
        (["line.yaml", "--horizon", "5 kg"], "5 kg"),
        (["line.yaml", "--replications", "0"], "--replications"),
    ],
)
def test_a_wrong_call_is_answered_with_what_is_right(words, said, tmp_path, monkeypatch):
    line(tmp_path)
    monkeypatch.chdir(tmp_path)
    code, _, complaint = opsim("doctor", "engines", *words)
    assert code == 2 and said in complaint


def test_doctor_alone_is_as_it_was_and_knows_the_nearest_word():
    assert opsim("doctor")[1].endswith("all well\n")
    code, _, complaint = opsim("doctor", "engnies")
    assert code == 2 and "did you mean 'engines'?" in complaint


QUICK = ("press_shop", "starter", "two_shift_plant")
"""Templates that ``make test`` writes; that all shipped scenarios are right is said in tests/test_shipped.py, too."""


@pytest.mark.parametrize(
    "template", [name if name in QUICK else pytest.param(name, marks=pytest.mark.slow) for name in shipped_scenarios()]
)
def test_what_init_writes_is_right(tmp_path, monkeypatch, template):
    monkeypatch.chdir(tmp_path)
    code, shown, _ = opsim("init", template)
    assert code == 0 and f"next: opsim check {template}.yaml" in shown
    assert opsim("check", f"{template}.yaml")[0] == 0


def test_the_schema_lies_beside_it_and_is_named_in_the_first_line(tmp_path):
    opsim("init", "queue", "-o", tmp_path / "mine" / "first.yaml")
    first, second, *_ = (tmp_path / "mine" / "first.yaml").read_text(encoding="utf-8").splitlines()
    assert first == "# yaml-language-server: $schema=./opsim.schema.json"
    assert second.startswith("# The oldest known answer")
    assert (tmp_path / "mine" / "opsim.schema.json").read_text(encoding="utf-8") == schema_text()


def test_without_a_template_it_is_a_short_commented_one(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert json.loads(opsim("init", "--json")[1]) == {
        "scenario": "starter.yaml",
        "template": "starter",
        "schema": "opsim.schema.json",
    }
    lines = (tmp_path / "starter.yaml").read_text(encoding="utf-8").splitlines()
    assert len(lines) < 40
    sections = [line for line in lines if (line[:1].isalpha() and line.endswith(":")) or "  # " in line]
    assert sections and all("  # " in line for line in sections)  # each section says what goes there


def test_the_short_one_is_checked_and_runs_as_it_stands(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    opsim("init", "-o", "my.yaml")
    assert opsim("check", "my.yaml")[0] == 0
    assert opsim("run", "my.yaml", "-o", "out", "--replications", 1, "--horizon", "3 h")[0] == 0
    assert {one.parent.name for one in tmp_path.glob("out/*/report.html")} == {"base", "busy", "busy_with_three"}


def test_no_file_is_written_over(tmp_path):
    path = tmp_path / "mine.yaml"
    path.write_text("mine")
    code, _, complaint = opsim("init", "-o", path)
    assert code == 2 and complaint.startswith(f"{path} is there already")
    assert [one.name for one in tmp_path.iterdir()] == ["mine.yaml"] and path.read_text() == "mine"


def test_a_schema_that_is_there_is_left_as_it_is(tmp_path):
    (tmp_path / "opsim.schema.json").write_text("{}")
    assert opsim("init", "-o", tmp_path / "mine.yaml")[0] == 0
    assert (tmp_path / "opsim.schema.json").read_text() == "{}"


def test_an_unknown_template_gets_the_nearest_word(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    code, _, complaint = opsim("init", "serialline")
    assert (code, complaint) == (2, "no template 'serialline'; did you mean 'serial_line'?\n")
    assert not list(tmp_path.iterdir())


def test_a_folder_that_cannot_be_made_is_a_mistake(tmp_path):
    (tmp_path / "file").write_text("")
    code, _, complaint = opsim("init", "-o", tmp_path / "file" / "mine.yaml")
    assert code == 2 and "file" in complaint


def test_the_templates_say_what_they_are(tmp_path):
    code, shown, _ = opsim("init", "--list")
    assert code == 0 and "A saturated line of three people" in shown
    templates = json.loads(opsim("init", "--list", "--json")[1])["templates"]
    assert set(templates) == set(shipped_scenarios()) and all(
        said.endswith((".", "?", "!")) for said in templates.values()
    )


def test_the_schema_is_printed():
    code, shown, _ = opsim("schema")
    assert code == 0 and json.loads(shown) == json_schema()


def test_the_schema_is_written_to_a_file(tmp_path):
    path = tmp_path / "opsim.schema.json"
    assert opsim("schema", "-o", path) == (0, f"schema {path}\n", "")
    assert json.loads(path.read_text(encoding="utf-8")) == json_schema()
    assert json.loads(opsim("schema", "-o", path, "--json")[1]) == {"schema": str(path)}


def test_a_file_that_cannot_be_written_is_a_mistake(tmp_path):
    code, _, complaint = opsim("schema", "-o", tmp_path)
    assert code == 2 and str(tmp_path) in complaint


PLANT = """
opsim: 1
name: Plant
run: {horizon: 8 h, replications: 1}
layout:
  distance: paths
  places: {here: [0 m, 0 m], there: [9 m, 0 m], yard: [90 m, 0 m]}
  paths: [[here, there]]
tasks: {do: {fixed: 30 s, automatic: true}}
stores: {rack: {at: here, capacity: 9}}
stations:
  cut: {at: here, tasks: [do], buffer: 3}
  fit: {at: there, tasks: [do], buffer: 3, maintenance: {oiling: {every: 2 h, lasts: 10 min}}}
  test: {at: there, tasks: [do], buffer: 3}
cards: {loop: {n: 4, from: cut, to: fit}}
transporters: {cart: {at: here, speed: 1 m/s, legs: [[cut, fit]], roads: [[here, there]]}}
products:
  bike: {route: [cut, fit, test], parts: {fit: {wheel: 2}}}
  wheel: {route: [cut, rack]}
  trial: {routing: {start: cut, cut: {test: 0.5, out: 0.5}, test: out}}
sources:
  calls: {kind: poisson, every: 10 min, products: [bike, trial]}
  refill: {kind: base_stock, store: rack, level: 4}
"""
OILING = "every: 2 h, lasts: 10 min"
WRONG = {
    "a kanban loop without cards": ("loop: {n: 4", "loop: {n: 0", "cards.loop.n", "n: 1"),
    "a bill of material that needs itself": (
        *("wheel: {route: [cut, rack]}", "wheel: {route: [cut, rack], parts: {cut: {wheel: 1}}}"),
        *("products.wheel.parts", "wheel needs wheel"),
    ),
    "a bill of material in a circle": (
        *("wheel: {route: [cut, rack]}", "wheel: {route: [cut, rack], parts: {cut: {bike: 1}}}"),
        *("products.", "needs"),
    ),
    "probabilities that sum to 1.2": ("{test: 0.5, out: 0.5}", "{test: 0.7, out: 0.5}", "trial.routing.cut", "1.2"),
    "a buffer of -1": ("[do], buffer: 3}\n  fit", "[do], buffer: -1}\n  fit", "stations.cut.buffer", "at least 0"),
    "a transporter without a road": ("roads: [[here, there]]", "roads: [[here, yard]]", "transporters.cart", "no road"),
    "maintenance longer than its period": (OILING, "every: 2 h, lasts: 3 h", "maintenance.oiling.lasts", "shorter"),
    "maintenance longer than the run": (OILING, "every: 90 h, first: 1 h, lasts: 9 h", "maintenance.oiling", "run"),
    "a route that skips where a part goes in": ("route: [cut, fit,", "route: [cut,", "products.bike.parts", "add fit"),
}
"""By what is wrong: what stands in the plant, what in its place, the place of the complaint, a word of the remedy."""


def test_the_plant_without_mistakes_is_fine(tmp_path):
    code, shown, complaint = opsim("check", line(tmp_path, PLANT))
    assert code == 0, complaint
    assert "no problems found" in shown


@pytest.mark.parametrize("what", WRONG)
def test_check_and_run_refuse_alike(tmp_path, what):
    old, new, place, remedy = WRONG[what]
    assert old in PLANT
    path = line(tmp_path, PLANT.replace(old, new))
    code, shown, complaint = opsim("check", path)
    assert (code, shown) == (2, "")
    assert f"{path.name}:" in complaint and place in complaint and remedy in complaint
    assert opsim("run", path, "-o", tmp_path / "out") == (code, shown, complaint)
    assert not (tmp_path / "out").exists()


def test_all_of_them_are_said_at_once(tmp_path):
    text = PLANT
    for old, new, _, _ in WRONG.values():
        text = text.replace(old, new)
    _, _, complaint = opsim("check", line(tmp_path, text))
    places = ["cards.loop.n", "trial.routing.cut", "cut.buffer", "fit.maintenance.oiling", "transporters.cart"]
    assert all(place in complaint for place in places)

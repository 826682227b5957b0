import json
import time

import pytest
from plans import many_stations

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
    assert code == 0 and "press cannot keep up: 250% of its time is wanted" in complaint


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
    assert code == 0 and "load of the skills" in shown and "however work is shared" in shown
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
    assert "ana cannot keep up: 119% of the time is wanted" in complaint
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

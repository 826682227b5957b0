"""Breakdowns and maintenance as they are written, and what is said of those that cannot be."""

from pathlib import Path

import pytest

from opsim.problems import ScenarioError
from opsim.scenario.read import scenarios_in

GOOD = (Path(__file__).parent / "good.yaml").read_text(encoding="utf-8")
TEAM = "repair_teams: {mechanics: {n: 2}}\n"
JAM = "{every: {dist: exponential, mean: 4 h}, repair: {fixed: 10 min}}"


def text(stops: str, more: str = TEAM) -> bytes:
    return (GOOD.replace("buffer: 4}", f"buffer: 4, {stops}}}") + more).encode()


def station(stops: str):
    return scenarios_in(text(stops), Path("line.yaml"))["base"].scenario.stations["pack"]


def said(stops: str, more: str = TEAM) -> str:
    with pytest.raises(ScenarioError) as caught:
        scenarios_in(text(stops, more), Path("line.yaml"))
    return str(caught.value)


def test_a_breakdown_is_by_the_clock_and_work_goes_on_unless_it_says_otherwise():
    jam = station(f"breakdowns: {{jam: {JAM}}}").breakdowns["jam"]
    assert (jam.by, jam.job, jam.team, jam.every.mean_s, jam.repair.fixed_s) == ("clock", "resume", None, 14400, 600)


@pytest.mark.parametrize("every", ["500", "{dist: geometric, mean: 99.5}", "{dist: uniform, low: 400, high: 500}"])
def test_cycles_are_numbers_without_a_unit(every):
    stops = f"breakdowns: {{jam: {{every: {every}, by: cycles, repair: {{fixed: 1 min}}}}}}"
    assert station(stops).breakdowns["jam"].by == "cycles"
    assert "by: busy needs a time, found a number of cycles" in said(stops.replace("cycles", "busy"))


def test_maintenance_is_due_after_its_period_unless_it_says_when():
    oiling = station("maintenance: {oiling: {every: 2 h, lasts: 20 min, team: mechanics}}").maintenance["oiling"]
    assert (oiling.every_s, oiling.first_s, oiling.lasts_s, oiling.when) == (7200, None, 1200, "after_job")


@pytest.mark.parametrize(("stops", "place", "found", "remedy"), [
    ("breakdowns: {jam: {every: 4 h, repair: {fixed: 1 min}}}",
     "stations.pack.breakdowns.jam.every", "'4 h' on average or exactly?", "{dist: exponential, mean: ...}"),
    ("breakdowns: {jam: {every: {fixed: 4 h}, repair: 10 min}}",
     "stations.pack.breakdowns.jam.repair", "'10 min' on average or exactly?", "{fixed: ...}"),
    ("breakdowns: {jam: {every: {fixed: 4 h}, by: cycles, repair: {fixed: 1 min}}}",
     "stations.pack.breakdowns.jam.every", "by: cycles counts operations, found a time", "such as 500"),
    ("breakdowns: {jam: {every: {dist: uniform, low: 9, high: 8}, by: cycles, repair: {fixed: 1 min}}}",
     "stations.pack.breakdowns.jam.every.low", "low (9) must be at most high (8)", ""),
    ("breakdowns: {jam: {evry: {fixed: 4 h}, repair: {fixed: 1 min}}}",
     "stations.pack.breakdowns.jam.evry", "unknown key 'evry'", "did you mean 'every'?"),
    ("breakdowns: {jam: {every: {fixed: 4 h}, repair: {fixed: 1 min, repeat: 2}}}",
     "stations.pack.breakdowns.jam.repair.repeat", "'repeat' means nothing here", "remove it"),
    ("breakdowns: {jam: {every: {fixed: 4 h}, repair: {emulator: moves/lift}}}",
     "stations.pack.breakdowns.jam.repair", "a time without a body is wanted here", "take fixed, recorded or dist"),
    ("breakdowns: {jam: {every: {fixed: 4 h}, repair: {recorded: no.csv}}}",
     "stations.pack.breakdowns.jam.repair.recorded", "no file 'no.csv' in the scenario's folder", ""),
    ("breakdowns: {jam: {every: {fixed: 4 h}, repair: {fixed: 1 min}, team: mechanix}}",
     "stations.pack.breakdowns.jam.team", "no repair team 'mechanix'", "did you mean 'mechanics'?"),
    ("maintenance: {oiling: {every: 1 h, lasts: 1 h}}",
     "stations.pack.maintenance.oiling.lasts", "lasts 3600 s and comes every 3600 s", "make it shorter, or rarer"),
    ("maintenance: {oiling: {every: 20 h, lasts: 8 h}}",
     "stations.pack.maintenance.oiling.lasts", "lasts 28800 s, and the whole run only 28800 s", "make it shorter"),
    ("maintenance: {oiling: {every: 2 h, lasts: 1 h}, cleaning: {every: 3 h, lasts: {fixed: 90 min}}}",
     "stations.pack.maintenance", "these together take 100% of the time", "make them shorter, or rarer"),
    (f"maintenance: {{jam: {{every: 2 h, lasts: 1 min}}}}, breakdowns: {{jam: {JAM}}}",
     "stations.pack.maintenance.jam", "a breakdown of this station is called 'jam' as well", "change one"),
])  # fmt: skip
def test_a_stop_that_cannot_be_is_refused_with_its_place_and_a_remedy(stops, place, found, remedy):
    answer = said(stops)
    assert f": {place}: {found}" in answer
    assert remedy in answer
    assert answer.endswith("\n1 problem in line.yaml")


def test_without_any_team_the_remedy_is_the_section():
    stops = "maintenance: {oiling: {every: 2 h, lasts: 1 min, team: mechanics}}"
    assert "add a section 'repair_teams: {mechanics: {n: 1}}'" in said(stops, "")


def test_a_team_of_nobody_is_refused():
    assert "repair_teams.mechanics.n: must be at least 1, found 0" in said("breakdowns: {}", TEAM.replace("2", "0"))

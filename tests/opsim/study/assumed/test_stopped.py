"""What the assumption sheet says of stops, and how the table of tasks names their repairs."""

import pytest
from plans import loaded

from opsim.plan import compile_plan
from opsim.study.assumptions.flow import stopped
from opsim.study.assumptions.sheet import task_sources

TEXT = """
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
    one = loaded(TEXT.replace("STOPS", stops))
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

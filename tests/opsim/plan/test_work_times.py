"""Loads by the speed of those who can do the work: skill ratings, pace, teams, tools."""

import pytest
from plans import plan

from opsim.plan.loads import crew_load, shared_loads, skill_loads, station_loads

EVERY_S = 90
FLOOR = f"""
opsim: 1
name: Speeds
run: {{horizon: 4 h}}
layout: {{places: {{here: [0 m, 0 m]}}}}
tools: {{gun: {{n: 1}}}}
tasks:
  do: {{fixed: 60 s, needs: {{gun: 1}}}}
  both: {{fixed: 40 s, team: 2}}
  stand_by: {{fixed: 60 s, automatic: attended}}
stations: {{s: {{at: here, tasks: [do]}}, t: {{at: here, tasks: [do]}}}}
products: {{p: {{route: [s]}}}}
release: {{kind: renewal, every: {{fixed: {EVERY_S} s}}}}
workers: {{ana: {{skills: {{s: 1}}}}}}
"""
HALF = "{ana: {skills: {s: 0.5}}, ben: {skills: {s: 0.5}}}"
MIXED = "{ana: {skills: {s: 0.5}}, ben: {skills: {s: 1.0}}}"
TEAM, ALONE = ("s: {at: here, tasks: [do]}", "s: {at: here, tasks: [both]}"), ("tasks: [do]", "tasks: [stand_by]")
SET_UP = ("s: {at: here, tasks: [do]", "s: {at: here, tasks: [do], setup: {times: {p: {p: 30 s}}, otherwise: 0 s}")


def floor(workers, *edits):
    text = FLOOR
    for old, new in (("{ana: {skills: {s: 1}}}", workers), *edits):
        assert old in text, old
        text = text.replace(old, new)
    return plan(text)


@pytest.mark.parametrize(
    ("workers", "edits", "visit_s", "each_visit_s", "tool_s"),
    [
        ("{ana: {skills: {s: 1}}}", [], 60, [60], 60),
        (HALF, [], 120, [120, 120], 120),
        (MIXED, [], 60, [120, 60], 60),  # the fastest bounds the station; both share the skill
        (HALF, [ALONE], 60, [60, 60], 0),  # a machine keeps its own time
        (HALF, [SET_UP], 180, [180, 180], 120),
        (HALF, [SET_UP, ("otherwise: 0 s", "otherwise: 0 s, attended: false")], 150, [120, 120], 120),
        (MIXED, [TEAM], 80, [160, 160], 0),  # the slowest of two ends it, and both are there
    ],
    ids=["as rated", "both slow", "mixed", "beside a machine", "set-up", "set-up by itself", "team"],
)
def test_loads_go_by_the_speed_of_those_who_can(workers, edits, visit_s, each_visit_s, tool_s):
    made = floor(workers, *edits)
    station, skill, gun = station_loads(made)[0], skill_loads(made)[0], shared_loads(made)[0]
    assert station.load == pytest.approx(visit_s / EVERY_S)
    assert station.most_per_h == pytest.approx(3600 / visit_s)
    assert gun.load == pytest.approx(tool_s / EVERY_S)
    assert skill.load == crew_load(made).share == pytest.approx(1 / EVERY_S / sum(1 / s for s in each_visit_s))
    assert skill.wanted == pytest.approx(len(each_visit_s) * skill.load)


@pytest.mark.parametrize(
    ("ana", "ben", "share"),
    [
        ("{s: 1.0, t: 0.5}", "{s: 0.5, t: 1.0}", 60 / 90),  # each does what he is good at
        ("{s: 1.0, t: 1.0}", "{s: 0.5, t: 0.5}", 120 / 90 / 1.5),
        ("{s: 1.0, t: 1.0}", "{s: 0.25, t: 0.2}", 96 / 90),  # ben does 2 of 5 at s: 96 s; ana 36 s there, 60 s at t
    ],
)
def test_people_share_work_by_their_own_speeds(ana, ben, share):
    route = ("route: [s]", "route: [s, t]")
    made = floor(f"{{ana: {{skills: {ana}}}, ben: {{skills: {ben}}}}}", route)
    assert crew_load(made).share == pytest.approx(share)


@pytest.mark.parametrize("pace", [0.5, 2.0])
def test_an_emulated_task_takes_as_long_as_the_pace_that_is_asked_for(pace):
    edits = [
        ("run: {horizon: 4 h}", "run: {horizon: 4 h, variability: none}\nlibraries: {work: libraries/bench_work.npz}"),
        ("{fixed: 60 s, needs: {gun: 1}}", "{emulator: work/fasten}"),
    ]
    usual, asked = (floor(f"{{ana: {{{more}skills: {{s: 1}}}}}}", *edits) for more in ("", f"pace: {pace}, "))
    assert station_loads(asked)[0].load == pytest.approx(station_loads(usual)[0].load / pace)
    assert skill_loads(asked)[0].load == pytest.approx(skill_loads(usual)[0].load / pace)

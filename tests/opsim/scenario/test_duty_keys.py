"""What people may say of absence and interruption, and what is refused."""

import pytest
from plans import CELL, loaded, plan

from opsim.problems import ScenarioError

SHIFTS = "shifts: {early: {from: 06:00, to: 14:00}}\n"
ANA = "ana: {skills: {unload: 1.0, repack1: 1.1}}"


def refused(*edits):
    text = CELL + SHIFTS
    for old, new in edits:
        assert old in text, old
        text = text.replace(old, new)
    with pytest.raises(ScenarioError) as found:
        loaded(text)
    return str(found.value)


def test_absence_and_interruption_come_into_the_plan():
    text = (CELL + SHIFTS).replace(ANA, ANA.replace("{skills", "{shift: early, absence: 0.05, skills"))
    text = text.replace("between_share: 0.4}", "between_share: 0.4, interruption: hand_over}")
    p = plan(text)
    assert [worker.absence for worker in p.workers] == [0.05, 0, 0]
    assert {task.name: task.interruption for task in p.tasks}["lift"] == "hand_over"


def test_who_is_always_there_misses_no_shift():
    said = refused((ANA, ANA.replace("{skills", "{absence: 0.05, skills")))
    assert "workers.ana.absence: who has no shift is always there" in said and "name the shift" in said


def test_a_share_of_shifts_is_between_none_and_all():
    assert "workers.ana.absence" in refused((ANA, ANA.replace("{skills", "{shift: early, absence: 1.5, skills")))


def test_an_unknown_rule_is_told_with_the_known_ones():
    said = refused(("between_share: 0.4}", "between_share: 0.4, interruption: handover}"))
    assert "tasks.lift.interruption" in said and "hand_over" in said


def test_nobody_leaves_what_a_station_does_alone():
    said = refused(("{fixed: 30 s, automatic: true}", "{fixed: 30 s, automatic: true, interruption: finish}"))
    assert "tasks.press.interruption: no worker leaves what the station does alone" in said

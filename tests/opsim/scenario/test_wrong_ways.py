"""Floors that would wait for ever, or for which no way leads: refused by the checks."""

from pathlib import Path

import pytest

from opsim.problems import ScenarioError
from opsim.scenario.read import scenarios_in

TWO = """
opsim: 1
name: two
run: {horizon: 1 h}
layout: {distance: paths, places: {a: [0 m, 0 m], b: [6 m, 0 m], c: [3 m, 0 m]}, paths: [[a, c]]}
tasks: {t: {fixed: 10 s}}
stations: {s1: {at: a, tasks: [t]}, s2: {at: b, tasks: [t]}}
products: {p: {route: [s1, s2], carried: true}}
release: {kind: renewal, every: {fixed: 30 s}}
workers: {w: {skills: {s1: 1}}, v: {skills: {s2: 1}}}
"""
ROUTING = "routing: {start: s1, s1: {s2: 0.5, out: 0.5}, s2: out}"


def said(text: str) -> str:
    with pytest.raises(ScenarioError) as caught:
        scenarios_in(text.encode(), Path("two.yaml"))
    return str(caught.value)


@pytest.mark.parametrize("way", ["route: [s1, s2]", ROUTING])
def test_who_carries_needs_a_way_to_where_he_carries(way):
    assert "no path leads from 'a' to 'b', and w has to walk there" in said(TWO.replace("route: [s1, s2]", way))
    assert set(scenarios_in(TWO.replace("true", "false").encode(), Path("two.yaml"))) == {"base"}
    assert set(scenarios_in(TWO.replace("[[a, c]]", "[[a, c, b]]").encode(), Path("two.yaml"))) == {"base"}


def test_a_station_that_no_round_comes_by_is_refused():
    text = TWO.replace("[[a, c]]", "[[a, c, b]]").replace("s1: 1}", "s1: 1, s2: 1}, patrol: [s1]")
    text = text.replace(", v: {skills: {s2: 1}}", "") + "allocation: {idle: patrol}\n"
    assert "task 't' needs a worker, and nobody goes round by 's2'" in said(text)
    mended = text.replace("patrol: [s1]", "patrol: [s1, s2]")
    assert set(scenarios_in(mended.encode(), Path("two.yaml"))) == {"base"}


@pytest.mark.parametrize("stop", ["[]", "[s1]", "{s1: 1}", "null", "7"])
def test_a_stop_of_a_round_that_is_no_name_is_refused(stop):
    text = TWO.replace("[[a, c]]", "[[a, c, b]]").replace(
        "{skills: {s1: 1}}", f"{{skills: {{s1: 1}}, patrol: [{stop}]}}"
    )
    assert "patrol" in said(text + "allocation: {idle: patrol}\n")

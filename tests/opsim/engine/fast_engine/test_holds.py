"""A tool in the hands between two moments: taken, waited for and given back where SimPy's engine does."""

import pytest
from twins import twins

from opsim.log import HELD, NO_TOOL, TOOL, WAIT

CELL = """
opsim: 1
name: holds
run: {horizon: 600 s, seed: 1}
libraries: {work: libraries/bench_work.npz}
layout: {places: {a: [0 m, 0 m], b: [2 m, 0 m]}}
tools: {gun: {n: 1}}
tasks: {make: {fixed: 10 s, hold: {tool: gun, from: 0.2, to: 0.6}}, pack: {fixed: 3 s}}
stations:
  s1: {at: a, tasks: [make, pack], servers: 2, buffer: 1}
  s2: {at: b, tasks: [make], buffer: 1}
products: {part: {route: [[s1, s2]]}}
release: {kind: saturated}
workers: {w1: {skills: {s1: 1.0}}, w2: {skills: {s2: 0.7, s1: 1.1}}, w3: {skills: {s1: 0.9}}}
"""
JAM = "breakdowns: {jam: {every: {fixed: 13 s}, by: busy, repair: {fixed: 7 s}, job: %s}}, "


def n_waits(log, kind=WAIT):
    return len(log.where((log["kind"] == kind) & (log["cause"] == NO_TOOL)))


@pytest.mark.parametrize(
    "moments", ["from: 0.2, to: 0.6", "to: 0.5", "from: 0.5", "from: 0, to: 1", "from: 0.3, to: 0.31"]
)
def test_who_finds_no_tool_waits_at_the_same_moment(moments):
    log = twins(CELL, ("from: 0.2, to: 0.6", moments))
    assert moments.endswith("0.31") or (n_waits(log) > 20 and n_waits(log, HELD) > 20)


@pytest.mark.parametrize("job", ["resume", "restart", "scrap"])
def test_what_is_broken_off_goes_on_with_the_same_moments(job):
    log = twins(CELL, ("s1: {at: a,", f"s1: {{at: a, {JAM % job}"), ("s2: {at: b,", f"s2: {{at: b, {JAM % job}"))
    assert n_waits(log) > 10 and len(log.of(TOOL)) > 20


def test_an_attended_run_holds_the_tool_at_the_station_s_pace():
    log = twins(
        CELL, ("fixed: 10 s", "fixed: 10 s, automatic: attended"), ("s1: {at: a,", f"s1: {{at: a, {JAM % 'resume'}")
    )
    assert n_waits(log) > 10


@pytest.mark.parametrize("how", ["", "automatic: attended, "])
def test_drawn_times_bring_their_own_moments(how):
    drawn = f"make: {{{how}dist: lognormal, mean: 10 s, cv: 0.3, "
    log = twins(CELL, ("make: {fixed: 10 s, ", drawn), ("600 s", "1 h"))
    assert n_waits(log) > 50

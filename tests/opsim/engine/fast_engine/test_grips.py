"""Rows of tools: one for each piece, and waits that name the task whose tools were missing."""

from twins import twins

from opsim.log import HELD, NO_TOOL, TOOL

TWO = """
opsim: 1
name: grips
run: {horizon: 95 s, seed: 1}
layout: {places: {a: [0 m, 0 m]}}
tools: {clamp: {n: 3}}
tasks: {one: {fixed: 4 s, needs: {clamp: 2}}, two: {fixed: 6 s, needs: {clamp: 3}}}
stations: {s: {at: a, tasks: [one], buffer: 1}, t: {at: a, tasks: [two], buffer: 1}}
products: {p: {route: [[s, t]]}}
release: {kind: saturated}
workers: {w1: {skills: {s: 1.0}}, w2: {skills: {t: 1.0}}}
"""


def test_each_piece_has_a_row_and_each_wait_its_task():
    log = twins(TWO)
    rows = log.of(TOOL)
    assert {2, 3} == {int((rows["start_s"] == start_s).sum()) for start_s in set(rows["start_s"].tolist())}
    waits = log.where((log["kind"] == HELD) & (log["cause"] == NO_TOOL))
    assert len(set(waits["task"].tolist())) == 2

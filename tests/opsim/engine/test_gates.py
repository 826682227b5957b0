"""Who wants in where there is no room: only who would come back is looked for among the others."""

import numpy as np
import plans
import pytest

from opsim.engine.floor import build, routing

BACKLOG = """
opsim: 1
name: backlog
run: {horizon: 200 s}
layout: {places: {hall: [0 m, 0 m]}}
tasks: {cut: {fixed: 5 s, automatic: true}, drill: {fixed: 4 s, automatic: true}}
stations: {saw: {at: hall, tasks: [cut], buffer: 1}, mill: {at: hall, tasks: [drill], buffer: 1}}
products: {bar: {route: [saw, mill]}}
release: {kind: poisson, every: 2 s}
"""
ROUTES = {
    "straight on": [],
    "twice at one station": [("route: [saw, mill]", "route: [saw, saw, mill]")],
    "back to one of two": [("route: [saw, mill]", "route: [[saw, mill], [saw, mill]]")],
    "place first": [("buffer: 1}, mill", "buffer: 1, blocking: before}, mill")],
    "rework": [("at: hall, tasks: [drill], buffer: 1", "at: hall, tasks: [drill], buffer: 1, yield: 0.7, "
               "inspect: {finds: 1, then: {rework: mill}}")],
}  # fmt: skip


@pytest.mark.parametrize("edits", ROUTES.values(), ids=ROUTES)
def test_looking_at_every_claim_would_find_the_same(edits, monkeypatch):
    log, _ = plans.ran(BACKLOG, *edits)
    monkeypatch.setattr(build, "_comes_back", lambda *_: True)
    twin, _ = plans.ran(BACKLOG, *edits)
    assert all(np.array_equal(log[name], twin[name], equal_nan=True) for name in log.columns)


def test_a_queue_outside_is_not_gone_through_where_nobody_comes_back(monkeypatch):
    asked = []
    may_enter = routing.may_enter
    monkeypatch.setattr(routing, "may_enter", lambda *what: asked.append(what) or may_enter(*what))
    plans.ran(BACKLOG)
    assert not asked
    plans.ran(BACKLOG, *ROUTES["twice at one station"])
    assert asked

"""Batches on one server and lots: known answers by hand, and the laws."""

import numpy as np
import plans
import pytest
from plans import loaded

from opsim import log as kinds
from opsim.clock import on_grid
from opsim.engine.rules import batch_begins
from opsim.plan.warnings import risks_of

OVEN = """
opsim: 1
name: oven
run: {horizon: 1000 s}
layout: {places: {here: [0 m, 0 m]}}
tasks: {bake: {fixed: 50 s, automatic: true}}
stations: {oven: {at: here, tasks: [bake], batch: {size: 4}}}
products: {a: {route: [oven]}, b: {route: [oven]}}
sources: {loaves: {kind: renewal, every: {fixed: 10 s}, sequence: [a, b]}}
"""


def ran(*edits):
    return plans.ran(OVEN, *edits)[0]


def baked(log):
    """(start, jobs) of each batch."""
    work = log.where((log["kind"] == kinds.WORK) & (log["task"] == log.names["task"].index("bake")))
    at, n = np.unique(np.concatenate([_begun(log), work["start_s"]]), return_counts=True)
    return list(zip(at.tolist(), n.tolist()))


def _begun(log):
    return log.where((log["kind"] == kinds.HELD) & (log["cause"] == kinds.BATCH))["start_s"]


def test_a_batch_begins_when_it_is_full_and_its_task_is_done_once():
    """Jobs at 10, 20, 30, 40: the first batch bakes from 40 to 90, the next ones, 4 of 5 that came, at once after."""
    log = ran()
    assert baked(log)[:4] == [(40.0, 4), (90.0, 4), (140.0, 4), (190.0, 4)]
    assert log.of(kinds.FINISH)["end_s"][:8].tolist() == [90.0] * 4 + [140.0] * 4
    assert len(log.of(kinds.WORK)) == 20  # the last one is cut off by the horizon


def test_waiting_for_the_batch_is_told_from_waiting_for_the_oven():
    """The first job waits 30 s for the others; the fifth, from 50 s on, waits for the oven."""
    log = ran()
    waits = log.of(kinds.QUEUE)
    of = {job: waits.where(waits["job"] == job) for job in (0, 4)}
    assert of[0]["cause"].tolist() == [kinds.BATCH] and of[0].duration_s.tolist() == [30.0]
    assert of[4]["cause"].tolist() == [0] and of[4].duration_s.tolist() == [40.0]


def test_who_has_waited_long_enough_goes_with_those_there_are():
    """At 10 + 25 s there are two more, of 20 and 30 s: three bake from 35 to 85, when the first of four is overdue."""
    log = ran(("size: 4", "size: 9, most_wait: 25 s"))
    assert baked(log)[:3] == [(35.0, 3), (85.0, 5), (135.0, 5)]


def test_who_comes_at_the_very_instant_goes_along():
    """At 10 + 20 s the third job comes as the first has waited long enough."""
    assert baked(ran(("size: 4", "size: 9, most_wait: 20 s")))[0] == (30.0, 3)


@pytest.mark.parametrize("of", ["product", "family"])
def test_only_jobs_of_one_kind_go_together(of):
    """Of a and b in turn four a are together at 70 s, and four b at 80 s."""
    log = ran(("size: 4", f"size: 4, of: {of}"), ("tasks: [bake]", "servers: 2, tasks: [bake]"))
    assert baked(log)[:2] == [(70.0, 4), (80.0, 4)]
    done = log.of(kinds.FINISH)
    assert [log.names["product"][p] for p in done["product"][:8]] == ["a"] * 4 + ["b"] * 4


def test_a_family_goes_together():
    log = ran(
        ("size: 4", "size: 4, of: family"),
        ("{a: {route", "{a: {family: x, route"),
        ("b: {route", "b: {family: x, route"),
    )
    assert baked(log)[0] == (40.0, 4)


@pytest.mark.parametrize("wait_s", [6.3, 6.4])
def test_a_longest_wait_between_two_ticks_ends_at_one_of_them(wait_s):
    log = ran(("size: 4", f"size: 4, most_wait: {wait_s} s"), ("fixed: 10 s}, seq", "fixed: 70 s}, seq"))
    assert baked(log)[:2] == [(70 + on_grid(wait_s), 1), (140 + on_grid(wait_s), 1)]


def test_an_oven_that_is_down_takes_whoever_is_there_when_it_goes_on():
    """It is down from 15 s to 60 s; at 20 s and at 40 s somebody has waited long enough."""
    jam = "batch: {size: 5, most_wait: 10 s}, breakdowns: {jam: {every: {fixed: 15 s}, repair: {fixed: 45 s}}}"
    assert baked(ran(("batch: {size: 4}", jam)))[0] == (60.0, 5)


def test_the_buffer_limits_who_waits_and_not_who_bakes():
    """Eight places in the oven and the buffer: what comes while four bake and four wait is lost."""
    log = ran(
        ("batch: {size: 4}", "buffer: 4, batch: {size: 4}"),
        ("fixed: 10 s}", "fixed: 5 s}"),
        ("[a, b]}", "[a, b], when_full: lose}"),
    )
    assert baked(log)[:3] == [(20.0, 4), (70.0, 4), (120.0, 4)]
    assert log.of(kinds.LOST)["end_s"][:2].tolist() == [45.0, 50.0]


def test_room_opens_in_the_buffer_as_a_batch_begins():
    """a, b, a, b fill four places until 40 s; the a of 50 s comes in at 55 s, when two a have waited long enough."""
    log = ran(("batch: {size: 4}", "buffer: 4, batch: {size: 4, of: product, most_wait: 45 s}"))
    assert baked(log)[0] == (55.0, 2)
    inside = log.where((log["kind"] == kinds.QUEUE) & (log["job"] == 4))
    assert inside["start_s"][0] == 55.0


def test_a_task_is_done_once_for_a_batch_of_lots():
    log = ran(("{a: {route", "{a: {lot: 3, route"), ("b: {route", "b: {lot: 3, route"))
    assert baked(log)[:2] == [(40.0, 4), (90.0, 4)] and len(log.of(kinds.FINISH)) == 76


def test_two_ovens_take_a_batch_each():
    log = ran(("tasks: [bake]", "servers: 2, tasks: [bake]"))
    assert baked(log)[:4] == [(40.0, 4), (80.0, 4), (120.0, 4), (160.0, 4)]


def test_a_worker_does_the_task_once_for_all():
    log = ran(
        ("fixed: 50 s, automatic: true", "fixed: 50 s"), ("products:", "workers: {w: {skills: {oven: 1}}}\nproducts:")
    )
    work = log.of(kinds.WORK)
    assert len(work) == 20 and set(work["worker"]) == {0}
    assert len(log.of(kinds.FINISH)) == 76


def test_each_of_a_batch_goes_its_own_way():
    """What is baked together is packed one by one, one every 5 s; the oven is free when the last has left it."""
    log = ran(
        ("stations: {", "stations: {pack: {at: here, tasks: [pack], buffer: 0}, "),
        ("tasks: {", "tasks: {pack: {fixed: 5 s, automatic: true}, "),
        ("a: {route: [oven]}, b: {route: [oven]}", "a: {route: [oven, pack]}, b: {route: [oven, pack]}"),
    )
    assert log.of(kinds.FINISH)["end_s"][:5].tolist() == [95.0, 100.0, 105.0, 110.0, 160.0]
    assert baked(log)[:2] == [(40.0, 4), (105.0, 4)]


def test_a_batch_of_kits_takes_the_parts_of_all():
    log = ran(
        ("stations:", "stores: {tins: {at: here}}\nstations:"),
        (
            "products: {a: {route: [oven]}",
            "products: {tin: {route: [tins]}, a: {route: [oven], parts: {oven: {tin: 2}}}",
        ),
        ("sources: {", "sources: {tins: {kind: renewal, every: {fixed: 20 s}, products: [tin]}, "),
    )
    assert _begun(log)[:3].tolist() == [40.0] * 3 and log.of(kinds.WORK)["start_s"][0] == 80.0
    assert log.of(kinds.JOIN)["end_s"][:4].tolist() == [80.0] * 4


def test_members_of_a_batch_are_looked_at_one_by_one():
    log = ran(("tasks: [bake]", "tasks: [bake], scrap: 0.5"))
    _, n_good = np.unique(log.of(kinds.FINISH)["end_s"], return_counts=True)
    assert len(log.of(kinds.SCRAP)) + n_good.sum() == 76 and {1, 2, 3} & set(n_good)


def test_a_lot_is_worked_on_unit_by_unit_but_for_what_is_done_once():
    """Lots of 3: setting takes 10 s once, turning 2 x 5 s for each unit: 40 s a lot."""
    log = ran(
        ("{bake: {fixed: 50 s, automatic: true}}",
         "{set: {fixed: 10 s, automatic: true, per: lot}, turn: {fixed: 5 s, automatic: true, repeat: 2}}"),
        ("tasks: [bake], batch: {size: 4}", "tasks: [set, turn]"),
        ("a: {route", "a: {lot: 3, route"),
        ("b: {route", "b: {lot: 3, route"),
        ("fixed: 10 s}, seq", "fixed: 45 s}, seq"),
    )  # fmt: skip
    work = log.of(kinds.WORK)
    first = work.where(work["job"] == 0)
    assert first.duration_s.tolist() == [10.0, *[5.0] * 6]
    assert log.of(kinds.FINISH)["end_s"][:2].tolist() == [85.0, 130.0]


@pytest.mark.parametrize(("n", "longest_s", "begins"), [(4, 0.0, True), (3, 9.0, False), (1, 10.0, True)])
def test_the_rule_of_batches(n, longest_s, begins):
    assert batch_begins(n, 4, longest_s, 10.0) is begins


def test_the_order_of_declaration_decides_nothing():
    one = ran(("size: 4", "size: 3, of: product, most_wait: 40 s"))
    other = ran(
        ("size: 4", "of: product, most_wait: 40 s, size: 3"),
        ("{a: {route: [oven]}, b: {route: [oven]}}", "{b: {route: [oven]}, a: {route: [oven]}}"),
    )
    assert all(np.array_equal(one[c], other[c], equal_nan=True) for c in one.columns)


def test_who_comes_back_to_the_oven_waits_for_a_place_in_its_buffer():
    """Four bake and four wait in four places: those that bake twice have no place, and this is foretold."""
    twice = (
        ("batch: {size: 4}", "buffer: 4, batch: {size: 4}"),
        ("{a: {route: [oven]}, b: {route: [oven]}}", "{a: {route: [oven, oven]}, b: {route: [oven, oven]}}"),
    )
    log = ran(*twice)
    assert baked(log) == [(40.0, 4)] and len(log.of(kinds.FINISH)) == 0
    text = OVEN
    for old, new in twice:
        text = text.replace(old, new)
    (risk,) = risks_of(loaded(text).scenario)
    assert risk.startswith("jobs that share a server of oven come back to it at once: when its buffer is full")
    free = ran(("batch: {size: 4}", "batch: {size: 4}"), twice[1])
    assert len(free.of(kinds.FINISH)) > 20


def test_a_tool_of_the_oven_stays_until_the_last_of_the_batch_has_left():
    """Two bake from 20 to 70 s; they are packed one by one, so the second leaves at 75 s, and the tray with it."""
    log = ran(
        ("stations: {", "tools: {tray: {n: 1}}\nstations: {pack: {at: here, tasks: [pack], buffer: 0}, "),
        ("tasks: {", "tasks: {pack: {fixed: 5 s, automatic: true}, "),
        ("{size: 4}", "{size: 2}, needs: {tray: 1}, servers: 2"),
        ("a: {route: [oven]}, b: {route: [oven]}", "a: {route: [oven, pack]}, b: {route: [oven, pack]}"),
    )
    tray = log.of(kinds.TOOL)
    assert list(zip(tray["start_s"].tolist(), tray["end_s"].tolist()))[:3] == [
        (20.0, 70.0),
        (70.0, 75.0),
        (75.0, 125.0),
    ]
    assert tray["job"][:3].tolist() == [0, 1, 2]

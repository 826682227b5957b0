"""Disassembly: known answers by hand, the luck of pieces, and the laws."""

import numpy as np
import plans
import pytest
from made import shops as made_shops

from opsim import log as kinds

SAW = """
opsim: 1
name: saw
run: {horizon: 1000 s, seed: 3}
layout: {places: {here: [0 m, 0 m]}}
tasks:
  cut: {fixed: 20 s, automatic: true}
  plane: {fixed: 6 s, automatic: true}
  press: {fixed: 5 s, automatic: true}
stations:
  saw: {at: here, tasks: [cut], buffer: 2}
  plane: {at: here, tasks: [plane], buffer: 0}
  press: {at: here, tasks: [press]}
products:
  log: {route: [saw], split: {saw: {board: 3, dust: 1}}}
  board: {route: [plane]}
  dust: {route: [press]}
sources:
  logs: {kind: renewal, every: {fixed: 40 s}, products: [log]}
"""


def ran(*edits):
    return plans.ran(SAW, *edits)[0]


def of_product(log, name):
    return log.where(log["product"] == log.names["product"].index(name))


def test_a_log_becomes_boards_that_share_its_server_until_the_last_has_left():
    """The log of 10 s is cut at 30: boards are planed from 30, 36 and 42 on, so the saw is free at 42."""
    log = ran(("fixed: 40 s", "fixed: 10 s"))
    assert of_product(log, "board").of(kinds.FINISH)["end_s"][:3].tolist() == [36.0, 42.0, 48.0]
    assert of_product(log, "log").of(kinds.WORK)["start_s"][:2].tolist() == [10.0, 42.0]
    waits = of_product(log, "board").of(kinds.BLOCKED)
    assert waits.duration_s[:2].tolist() == [6.0, 12.0]
    assert of_product(log, "dust").of(kinds.FINISH)["end_s"][0] == 35.0


def test_pieces_name_the_log_they_are_of_and_come_when_it_goes():
    log = ran()
    gone, made = log.of(kinds.SPLIT), log.of(kinds.CREATE)
    pieces = made.where(made["k"] >= 0)
    for number, when in zip(gone["job"], gone["end_s"]):
        own = pieces.where(pieces["k"] == number)
        assert len(own) == 4 and set(own["end_s"]) == {when}
    assert {log.names["source"][rank] for rank in pieces["source"]} == {"logs > board", "logs > dust"}


def test_the_queue_behind_has_its_places_while_pieces_stand_on_the_server():
    """Logs come faster than they are cut: two always wait in the two places, however many boards stand on the saw."""
    log = of_product(ran(("fixed: 40 s", "fixed: 5 s"), ("products: [log]", "products: [log], when_full: lose")), "log")
    queued = log.of(kinds.QUEUE)
    at = np.arange(100.0, 900.0, 7.0)
    assert {int(np.sum((queued["start_s"] <= t) & (queued["end_s"] > t))) for t in at} <= {1, 2}
    assert len(log.of(kinds.LOST)) > 50


def test_the_luck_of_a_piece_is_that_of_its_log_however_many_came_before():
    """Where boards go is drawn by the number of the log and of the board: longer cutting moves nobody's way."""
    ways = ("board: {route: [plane]}", "board: {routing: {start: {plane: 0.5, press: 0.5}, plane: out, press: out}}")
    longer = ("cut: {fixed: 20 s", "cut: {fixed: 30 s")
    servers = ("tasks: [cut], buffer: 2", "tasks: [cut], servers: 9")
    sources = ("fixed: 40 s", "dist: exponential, mean: 20 s")
    one, other = ran(ways, servers, sources), ran(ways, servers, sources, longer)
    first = [
        {job: log.names["operation"][op] for job, op in zip(made["job"], made["operation"])}
        for log in (one, other)
        for made in [of_product(log, "board").of(kinds.CREATE)]
    ]
    both = set(first[0]) & set(first[1])
    assert len(both) > 100 and all(first[0][job] == first[1][job] for job in both)


def test_lots_are_cut_into_lots():
    """A lot of 2 logs is 6 boards, in lots of 4: one of 4 and one of 2, planed unit by unit."""
    log = ran(("log: {route", "log: {lot: 2, route"), ("board: {route", "board: {lot: 4, route"))
    planed = of_product(log, "board").of(kinds.WORK)
    _, n_units = np.unique(planed["job"], return_counts=True)
    assert n_units[:4].tolist() == [4, 2, 4, 2]
    assert of_product(log, "log").of(kinds.WORK).duration_s[:2].tolist() == [20.0, 20.0]


def test_pieces_are_split_again():
    log = ran(("board: {route: [plane]}", "board: {route: [plane], split: {plane: {dust: 2}}}"))
    assert {log.names["source"][rank] for rank in log.of(kinds.CREATE)["source"]} == {
        *("logs", "logs > board", "logs > board > dust", "logs > dust")
    }
    boards = len(of_product(log, "board").of(kinds.SPLIT))
    assert len(of_product(log, "dust").of(kinds.CREATE)) == len(of_product(log, "log").of(kinds.SPLIT)) + 2 * boards


def test_what_comes_apart_can_be_put_together_again():
    """Pallets go round: goods are put on one, and taken off it."""
    log = ran(
        ("layout:", "stores: {pallets: {at: here, initial: 2}}\nlayout:"),
        ("log: {route: [saw], split: {saw: {board: 3, dust: 1}}}",
         "log: {route: [plane, saw], parts: {plane: {board: 1}}, split: {saw: {board: 1, dust: 2}}}"),
        ("board: {route: [plane]}", "board: {route: [pallets]}"),
    )  # fmt: skip
    lying = of_product(log, "board").of(kinds.QUEUE)
    inside = [np.sum((lying["start_s"] <= t) & (lying["end_s"] > t)) for t in np.arange(0.0, 1000.0, 10.0)]
    assert max(inside) == 2 and len(log.of(kinds.SPLIT)) > 20


def test_tools_of_the_station_are_free_when_the_job_is_split():
    """One jig for two saws: the second log is begun as the first is split, while its boards are still on the saw."""
    log = ran(
        ("tasks: [cut], buffer: 2", "servers: 2, needs: {jig: 1}, tasks: [cut], buffer: 2"),
        ("stations:", "tools: {jig: {n: 1}}\nstations:"),
        ("fixed: 40 s", "fixed: 10 s"),
    )
    assert of_product(log, "log").of(kinds.WORK)["start_s"][:2].tolist() == [10.0, 30.0]
    assert of_product(log, "board").of(kinds.BLOCKED)["end_s"][:2].tolist() == [36.0, 42.0]


def test_a_defect_goes_on_into_the_pieces():
    log = ran(("tasks: [cut]", "yield: 0.5, tasks: [cut]"))
    bad = set(of_product(log, "board").of(kinds.FINISH)["cause"])
    assert bad == {0, kinds.BAD}
    boards = of_product(log, "board")
    parent = dict(zip(boards.of(kinds.CREATE)["job"], boards.of(kinds.CREATE)["k"]))
    causes = {
        (parent[job], cause) for job, cause in zip(boards.of(kinds.FINISH)["job"], boards.of(kinds.FINISH)["cause"])
    }
    assert len(causes) == len({job for job, _ in causes})  # all boards of a log are alike


def test_a_split_frees_the_worker():
    log = ran(
        ("cut: {fixed: 20 s, automatic: true}", "cut: {fixed: 20 s}"),
        ("sources:", "workers: {w: {skills: {saw: 1}}}\nsources:"),
    )
    assert len(log.of(kinds.SPLIT)) > 20


@pytest.mark.parametrize("edit", [
    ("{board: 3, dust: 1}", "{dust: 1, board: 3}"),
    ("  board: {route: [plane]}\n  dust: {route: [press]}", "  dust: {route: [press]}\n  board: {route: [plane]}"),
])  # fmt: skip
def test_the_order_of_declaration_decides_nothing(edit):
    one, other = ran(("fixed: 40 s", "fixed: 10 s")), ran(("fixed: 40 s", "fixed: 10 s"), edit)
    assert one.names == other.names
    assert all(np.array_equal(one[c], other[c], equal_nan=True) for c in one.columns)


def test_the_server_of_a_job_that_was_split_stays_set_up_as_it_is(tmp_path):
    """The other server, still set up for b, does the second b without a set-up while the boards stand on the first."""
    text = """
tasks: {cut: {fixed: 10 s, automatic: true}, slow: {fixed: 30 s, automatic: true}}
stations:
  saw: {at: hall, tasks: [cut], servers: 2, setup: {by: family, otherwise: 5 s, attended: false}}
  packer: {at: hall, tasks: [slow], buffer: 0}
products:
  a: {route: [saw], family: f, split: {saw: {board: 2}}}
  b: {route: [saw], family: g}
  board: {route: [packer, saw], family: g}
"""
    log = made_shops.ran(tmp_path, text, "0,b 0,a 20,b")
    assert [row for row in made_shops.spans(log, "work", "saw") if row[0] == "b"] == [("b", 0, 10), ("b", 20, 30)]

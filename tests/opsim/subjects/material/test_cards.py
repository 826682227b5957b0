"""Cards limit the jobs between two points: by hand arithmetic, and never more than there are."""

import numpy as np
import pytest
from plans import plan

from opsim.engine.floor.run import run_plan
from opsim.laws.audit import audit
from opsim.log import BLOCKED, CREATE, FINISH, HELD, LOST, NO_CARD, REWORK, WORK
from opsim.subjects.material import cards as card_gates
from tests.opsim.kpi.locking import LOOPS

HEAD = """
opsim: 1
name: loops
run: {horizon: 100 s}
layout: {places: {hall: [0 m, 0 m]}}
"""
LINE = """
tasks: {quick: {fixed: 1 s, automatic: true}, slow: {fixed: 5 s, automatic: true}}
stations: {s1: {at: hall, tasks: [quick]}, s2: {at: hall, tasks: [slow]}, s3: {at: hall, tasks: [quick]}}
products: {p: {route: [s1, s2, s3]}}
"""


def run(text):
    made = plan(HEAD + text)
    log = run_plan(made)
    audit(log, made)
    return log, made


def inside(log, product=None):
    """The most jobs between CREATE and FINISH at once, of those that a source makes only when they can enter."""
    mask = True if product is None else log["product"] == product
    ends = np.concatenate([log["end_s"][(log["kind"] == kind) & mask] for kind in (CREATE, FINISH)])
    steps = np.repeat([1, -1], [np.sum((log["kind"] == kind) & mask) for kind in (CREATE, FINISH)])
    return int(np.cumsum(steps[np.lexsort([steps, ends])]).max())


@pytest.mark.parametrize("n", [1, 2, 3, 7])
def test_conwip_keeps_so_many_jobs_inside_and_no_fewer(n):
    log, _ = run(LINE + f"release: {{kind: saturated}}\ncards: {{conwip: {{n: {n}}}}}\n")
    assert inside(log) == n
    finished = np.sort(log.of(FINISH)["end_s"])
    every_s = max(7.0 / n, 5.0)  # Hopp & Spearman: the best case, fixed times, W0 = 7 / 5
    assert finished[-1] - finished[-11] == pytest.approx(10 * every_s, abs=1e-4)


def test_the_worst_case_moves_all_jobs_as_one_pile():
    """Hopp & Spearman's worst case, here with a pile of one: nothing is ever worked on at two stations."""
    text = """
tasks: {much: {fixed: 4 s, automatic: true}}
stations: {s1: {at: hall, tasks: [much]}, s2: {at: hall, tasks: [much]}}
products: {p: {route: [s1, s2]}}
release: {kind: saturated}
cards: {conwip: {n: 1}}
"""
    log, _ = run(text)
    assert log.of(FINISH)["end_s"] == pytest.approx(np.arange(8, 100, 8))


def test_a_kanban_between_two_stations_blocks_before_the_first_of_them():
    """Between s1 and s3: s2 may hold one job with its one card, so jobs wait before it as if blocked at s1."""
    log, _ = run(LINE + "release: {kind: poisson, every: 1 s}\ncards: {loop: {n: 1, from: s2, to: s2}}\n")
    at_s2 = log.where((log["station"] == 1) & (log["kind"] == WORK))
    assert np.all(np.diff(at_s2["start_s"]) >= 5.0)
    waiting = log.where((log["kind"] == BLOCKED) & (log["cause"] == NO_CARD))
    assert set(waiting["station"]) == {0}
    assert not np.any((log["station"] == 1) & (log["kind"] == log.names["kind"].index("queue")))


def test_a_job_that_finds_no_card_waits_outside_or_is_lost():
    text = LINE + "release: {kind: renewal, every: {fixed: 3 s}}\ncards: {conwip: {n: 1}}\n"
    log, _ = run(text)
    outside = log.where((log["kind"] == HELD) & (log["cause"] == NO_CARD))
    assert (outside["start_s"][0], outside["end_s"][0]) == (6.0, 10.0)
    assert np.all(outside["station"] == -1)
    assert len(outside) == len(log.of(HELD)) > 10
    lost = run(text.replace("{fixed: 3 s}", "{fixed: 3 s}, when_full: lose"))[0].of(LOST)
    assert lost["end_s"][:3].tolist() == [6.0, 9.0, 15.0]
    assert set(lost["cause"]) == {NO_CARD}


def test_cards_of_one_product_leave_the_other_alone():
    text = """
tasks: {t: {fixed: 4 s, automatic: true}}
stations: {s1: {at: hall, tasks: [t], servers: 9}}
products: {a: {route: [s1]}, b: {route: [s1]}}
sources: {x: {kind: saturated, products: [a]}, y: {kind: poisson, every: 1 s, products: [b]}}
cards: {few: {n: 2, products: a}}
"""
    log, _ = run(text)
    assert inside(log, product=0) == 2
    assert inside(log, product=1) > 2


def test_the_oldest_job_gets_the_card_and_who_needs_none_passes_by():
    """a waits for its card from 1 s; b, behind it at the same gate, needs none and goes in."""
    text = """
tasks: {t: {fixed: 10 s, automatic: true}}
stations: {s1: {at: hall, tasks: [t], servers: 50}}
products: {a: {route: [s1]}, b: {route: [s1]}}
release: {kind: renewal, every: {fixed: 1 s}, sequence: [a, a, b, a]}
cards: {one: {n: 1, products: [a]}}
"""
    log, _ = run(text)
    work = log.of(WORK)
    first = {int(job): start for job, start in zip(work["job"], work["start_s"])}
    assert [first[job] for job in (0, 1, 2, 3)] == [1.0, 11.0, 3.0, 21.0]


def test_polca_takes_the_card_of_the_pair_before_the_first_and_keeps_it_through_the_second():
    """Pairs s1/s2 and s2/s3, one card each: s1 may begin only when the job before has left s2."""
    cards = "cards: {a_b: {n: 1, from: s1, to: s2}, b_c: {n: 1, from: s2, to: s3}}\n"
    log, _ = run(LINE + "release: {kind: saturated}\n" + cards)
    begun, left = (log.where((log["station"] == s) & (log["kind"] == WORK)) for s in (0, 1))
    assert begun["start_s"][:4].tolist() == [0.0, 6.0, 12.0, 18.0]
    assert left["end_s"][:3].tolist() == [6.0, 12.0, 18.0]


def test_who_comes_back_to_the_first_station_keeps_the_card():
    text = """
tasks: {t: {fixed: 1 s, automatic: true}}
stations: {s1: {at: hall, tasks: [t]}, s2: {at: hall, tasks: [t]}}
products: {p: {routing: {start: s1, s1: s2, s2: {s1: 0.5, out: 0.5}}}}
release: {kind: saturated}
cards: {conwip: {n: 2}}
"""
    log, _ = run(text)
    assert inside(log) == 2
    assert len(log.of(FINISH)) > 10


def test_a_card_given_back_on_the_way_to_the_same_loop_is_taken_again():
    """The way goes twice through the loop s1..s2: the only job never waits for its own card, and has it in both."""
    text = """
tasks: {t: {fixed: 1 s, automatic: true}}
stations: {s1: {at: hall, tasks: [t]}, s2: {at: hall, tasks: [t]}}
products: {p: {route: [s1, s2, s1, s2]}}
release: {kind: saturated}
cards: {loop: {n: 1, from: s1, to: s2}}
"""
    log, _ = run(text)
    assert log.of(FINISH)["end_s"][:3].tolist() == [4.0, 8.0, 12.0]
    assert not np.any(log["cause"] == NO_CARD)


def test_a_card_taken_on_leaving_the_end_of_its_own_loop_is_not_given_back_at_once():
    """Loops there and back over the same two stations: at most one job is on its way back, from s2 on to s1."""
    text = """
tasks: {t: {fixed: 1 s, automatic: true}, long: {fixed: 9 s, automatic: true}}
stations: {s1: {at: hall, tasks: [t]}, s2: {at: hall, tasks: [long], servers: 9}}
products: {p: {route: [s1, s2, s1]}}
release: {kind: poisson, every: 2 s}
cards: {back: {n: 1, from: s2, to: s1}}
"""
    log, _ = run(text)
    at_s2 = log.where((log["station"] == 1) & (log["kind"] == WORK))
    assert np.all(np.diff(np.sort(at_s2["start_s"])) >= 9.0)


@pytest.mark.parametrize(
    "cards", ["{x: {n: 2}, y: {n: 1, from: s2, to: s3}}", "{y: {n: 1, from: s2, to: s3}, x: {n: 2}}"]
)
def test_the_order_in_which_loops_are_declared_decides_nothing(cards):
    log, _ = run(LINE + f"release: {{kind: saturated}}\ncards: {cards}\n")
    assert log.of(FINISH)["end_s"][:4].tolist() == [7.0, 13.0, 19.0, 25.0]


def test_several_saturated_sources_take_turns():
    text = """
tasks: {t: {fixed: 1 s, automatic: true}}
stations: {s1: {at: hall, tasks: [t], buffer: 2}}
products: {a: {route: [s1]}, b: {route: [s1]}}
sources: {x: {kind: saturated, products: [a]}, y: {kind: saturated, products: [b]}}
"""
    log, _ = run(text)
    assert log.of(FINISH)["product"][:6].tolist() == [0, 1, 0, 1, 0, 1]


STOCK = """
tasks: {make: {fixed: 3 s, automatic: true}}
stations: {s1: {at: hall, tasks: [make]}, out: {at: hall, tasks: [], servers: 9}}
stores: {rack: {at: hall, initial: 2}}
products: {piece: {route: [s1, rack]}, order: {route: [out], parts: {out: {piece: 1}}}}
"""
ORDERS = "orders: {kind: renewal, every: {fixed: 20 s}, products: [order]}"


def test_a_kanban_makes_a_piece_when_one_is_taken_and_pieces_at_the_start_hold_cards():
    refill = "refill: {kind: saturated, products: [piece]}"
    log, _ = run(f"{STOCK}sources: {{{ORDERS}, {refill}}}\ncards: {{k: {{n: 2, from: s1, to: rack}}}}\n")
    work = log.of(WORK)
    assert work["start_s"].tolist() == [20.0, 40.0, 60.0, 80.0]
    assert log.of(FINISH)["end_s"].tolist() == [20.0, 40.0, 60.0, 80.0]


def test_who_goes_back_for_rework_passes_those_outside_since_he_has_a_card():
    """The first way through s1 fails and is repeated: the job has the only card, and others wait before it."""
    text = """
tasks: {t: {fixed: 1 s, automatic: true}}
stations:
  s1: {at: hall, tasks: [t], yield: 0.5}
  s2: {at: hall, tasks: [t], inspect: {then: {rework: s1}}}
products: {p: {route: [s1, s2]}}
release: {kind: poisson, every: 2 s}
cards: {conwip: {n: 1}}
"""
    log, _ = run(text)
    assert len(log.of(REWORK)) > 5
    assert log.of(FINISH)["end_s"].max() > 90


def test_jobs_outside_with_priorities_are_asked_in_their_order_each_time():
    """From 2 s on both wait for the card of job 0: the urgent one, which came last, has it first."""
    text = """
tasks: {t: {fixed: 10 s, automatic: true}}
stations: {s1: {at: hall, tasks: [t], servers: 9}}
products: {a: {route: [s1]}, urgent: {route: [s1], priority: 1}}
release: {kind: renewal, every: {fixed: 1 s}, sequence: [a, a, a, urgent]}
cards: {few: {n: 1}}
"""
    work = run(text)[0].of(WORK)
    assert work["job"][np.argsort(work["start_s"])][:4].tolist() == [0, 3, 7, 11]


def test_jobs_outside_are_not_all_looked_at_each_time_something_changes(monkeypatch):
    """A floor that stands still, and 2,400 jobs outside: each is told what it waits for a few times at most."""
    told, mark = [], card_gates._mark
    monkeypatch.setattr(card_gates, "_mark", lambda *what: (told.append(what[1].number), mark(*what)))
    log = run_plan(plan(LOOPS.replace("{n: 2,", "{n: 50,").replace("run: {horizon: 2 h}", "run: {horizon: 10 h}")))
    outside = np.sum((log["kind"] == HELD) & (log["station"] < 0) & (log["end_s"] == 36_000))
    assert outside > 2000
    assert len(told) < 5 * outside


def test_rework_from_a_passed_end_of_a_loop_to_before_it_gives_the_card_back():
    """Nothing is seen of x0 and s0, which are only passed: the law that counts cards knows it (``run`` audits)."""
    text = """
tasks: {m: {fixed: 2 s, automatic: true}}
stations:
  s0: {at: hall, tasks: [], yield: 0.5}
  s1: {at: hall, tasks: [m]}
  x0: {at: hall, tasks: [], inspect: {then: {rework: s0}}}
products: {q: {route: [s0, s1, x0]}}
cards: {loop: {n: 2, from: s1, to: x0}}
release: {kind: poisson, every: 2 s}
"""
    log, _ = run(text)
    assert len(log.of(REWORK)) > 10
    outside = log.where((log["cause"] == NO_CARD) & (log["kind"] == BLOCKED))
    assert np.isin(outside["job"], log.of(REWORK)["job"]).any()

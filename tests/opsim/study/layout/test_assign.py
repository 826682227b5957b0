"""Assignments against the literature, against trying all, and by what must not matter."""

from itertools import permutations

import numpy as np
import pytest

from opsim.study.layout import quadratic_assignment as assign
from opsim.study.layout.quadratic_assignment import Assignment, assigned, changes_step_by_step, costs

NUG12_FLOW = np.array(
    [[int(x) for x in row.split()] for row in """
0 5 2 4 1 0 0 6 2 1 1 1
5 0 3 0 2 2 2 0 4 5 0 0
2 3 0 0 0 0 0 5 5 2 2 2
4 0 0 0 5 2 2 10 0 0 5 5
1 2 0 5 0 10 0 0 0 5 1 1
0 2 0 2 10 0 5 1 1 5 4 0
0 2 0 2 0 5 0 10 5 2 3 3
6 0 5 10 0 1 10 0 0 0 5 0
2 4 5 0 0 1 5 0 0 0 10 10
1 5 2 0 5 5 2 0 0 0 5 0
1 0 2 5 1 4 3 5 10 5 0 2
1 0 2 5 1 0 3 0 10 0 2 0""".strip().splitlines()]
)  # fmt: skip
"""Nugent, Vollmann & Ruml 1968, Operations Research 16:150-173, as in QAPLIB (Burkard, Karisch & Rendl 1997)."""
NUG12_BEST = (12, 7, 9, 3, 4, 8, 11, 1, 5, 6, 10, 2)
"""An optimal permutation of QAPLIB: the thing at each place; its cost is 578."""


def grid(rows, columns):
    at = np.array([(row, column) for row in range(rows) for column in range(columns)])
    return np.abs(at[:, None] - at[None]).sum(axis=2).astype(float)


def some(rng, n, m):
    flow = rng.integers(0, 9, (n, n)).astype(float)
    np.fill_diagonal(flow, 0)
    at = rng.integers(0, 20, (m, 2)).astype(float)
    return flow, np.abs(at[:, None] - at[None]).sum(axis=2)


def by_hand(flow, distance, place_of):
    n = len(flow)
    return sum(flow[a, b] * distance[place_of[a], place_of[b]] for a in range(n) for b in range(n))


def test_the_optimum_of_qaplib_costs_what_qaplib_says():
    place_of = np.argsort(np.array(NUG12_BEST) - 1)
    assert costs(NUG12_FLOW, grid(3, 4), place_of[None])[0] == 578


def test_the_heuristic_finds_the_optimum_of_nug12():
    found = assigned(NUG12_FLOW.astype(float), grid(3, 4), now=range(12), most=3, seed=1)
    assert not found.exact
    assert found.best[0].cost == 578
    assert [one.cost for one in found.best] == sorted(one.cost for one in found.best)


@pytest.mark.parametrize("n, m, fixed", [(5, 5, ()), (4, 6, ()), (6, 6, (2,)), (5, 6, (0, 3))])
def test_small_ones_are_solved_exactly_and_as_by_hand(n, m, fixed):
    rng = np.random.default_rng(n * 10 + m)
    flow, distance = some(rng, n, m)
    now = rng.permutation(m)[:n].tolist()
    found = assigned(flow, distance, now=now, fixed=fixed)
    best = min(
        by_hand(flow, distance, way)
        for way in permutations(range(m), n)
        if all(way[thing] == now[thing] for thing in fixed)
    )
    assert found.exact
    assert found.best[0].cost == pytest.approx(best, rel=1e-12)
    assert all(found.best[0].place_of[thing] == now[thing] for thing in fixed)


@pytest.mark.parametrize("n, m, fixed", [(6, 7, ()), (7, 7, (1,)), (5, 8, (4,))])
def test_the_heuristic_finds_what_trying_all_finds(monkeypatch, n, m, fixed):
    rng = np.random.default_rng(n + m)
    flow, distance = some(rng, n, m)
    now = rng.permutation(m)[:n].tolist()
    exact = assigned(flow, distance, now=now, fixed=fixed)
    monkeypatch.setattr(assign, "MOST_ENUMERATED", 0)
    found = assigned(flow, distance, now=now, fixed=fixed)
    assert exact.exact and not found.exact
    assert found.best[0].cost == pytest.approx(exact.best[0].cost, rel=1e-12)
    assert all(found.best[0].place_of[thing] == now[thing] for thing in fixed)


def test_what_things_are_called_changes_nothing():
    flow, distance = some(np.random.default_rng(3), 6, 7)
    other = np.random.default_rng(4).permutation(6)
    now = np.arange(6)
    plain = assigned(flow, distance, now=now.tolist(), most=4)
    renamed = assigned(flow[np.ix_(other, other)], distance, now=now[other].tolist(), most=4)
    assert [one.cost for one in renamed.best] == pytest.approx([one.cost for one in plain.best])


def test_a_mirror_image_is_no_second_proposal_and_of_two_the_nearer_is_taken():
    flow = np.array([[0, 9, 0], [0, 0, 1], [0, 0, 0.0]])
    line = np.abs(np.subtract.outer([0.0, 1, 2], [0.0, 1, 2]))
    found = assigned(flow, line, now=[0, 1, 2], most=9)
    assert found.best[0] == Assignment((0, 1, 2), 10.0)
    assert len(found.best) == 3


def test_the_same_seed_gives_the_same_assignments():
    flow, distance = some(np.random.default_rng(5), 10, 12)
    one, two = (assigned(flow, distance, now=range(10), most=5, seed=8, starts=6) for _ in range(2))
    assert one == two


def test_each_single_change_is_the_best_one_and_pays():
    flow, distance = some(np.random.default_rng(16), 6, 8)
    now = list(range(6))
    path = changes_step_by_step(flow, distance, now=now, fixed=(0,), steps=4)
    assert by_hand(flow, distance, now) > path[0].cost > path[1].cost
    exchanged = [[b if x == a else a if x == b else x for x in now] for a in now[1:] for b in now[1:]]
    moved = [[place if x == a else x for x in now] for a in now[1:] for place in (6, 7)]
    assert path[0].cost == min(by_hand(flow, distance, way) for way in exchanged + moved)
    assert path[0].place_of[0] == 0


@pytest.mark.parametrize("most", [0, 400_000])
def test_nothing_is_put_where_it_may_not(monkeypatch, most):
    monkeypatch.setattr(assign, "MOST_ENUMERATED", most)
    flow, distance = some(np.random.default_rng(9), 4, 8)
    found = assigned(flow, distance, now=[0, 1, 2, 3], fixed=(3,), allowed=[1, 5, 6, 7], most=3)
    assert all(set(one.place_of[:3]) <= {1, 5, 6, 7} and one.place_of[3] == 3 for one in found.best)
    ways = [(*way, 3) for way in permutations([1, 5, 6, 7], 3)]
    assert found.best[0].cost == min(by_hand(flow, distance, way) for way in ways)


def test_more_things_than_places_are_refused():
    flow, distance = some(np.random.default_rng(7), 4, 3)
    with pytest.raises(ValueError, match="4 things do not fit on 3 places"):
        assigned(flow, distance, now=[0, 1, 2, 0])

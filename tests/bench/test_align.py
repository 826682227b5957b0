"""Registration against its plain twins and fdasrsf: the answer is asserted first, then the ratio.

fdasrsf is only there where ``make bench-peers`` installed it.
"""

from functools import partial

import numpy as np
import pytest
from bench.cpu import best_s, multiply_adds_per_s

from emulator.geometry import elastic
from emulator.geometry.alignment import align
from tests.made import made_sequences
from tests.naive import naive_elastic

N_PAIRS = 60


def fields(n, n_cells=300, seed=1):
    sequences, _, base = made_sequences(n, n_cells + 1, seed=seed)
    return sequences, elastic.tsrvf(sequences, base)


def test_a_pair_against_fdasrsf():
    peer = pytest.importorskip("optimum_reparamN2", reason="fdasrsf is not installed: make bench-peers")
    _, (q1, q2) = fields(2, seed=0)
    clock = np.linspace(0, 1, 301)
    nodes = [np.ascontiguousarray(np.vstack([q, q[-1:]]).T) for q in (q1, q2)]
    theirs = partial(peer.coptimum_reparam_curve, nodes[0], clock, nodes[1], 0.0, elastic.STEEPEST)
    ours = partial(elastic.pair_warp, q1, q2)
    assert np.abs(ours() - theirs()).max() < 1e-12
    assert elastic.best_warp(q1, q2)[1] == pytest.approx(worth(q1, q2, theirs()), rel=1e-9)
    theirs_s, ours_s = best_s(theirs, partial(repeat, ours, 20), rounds=3)
    print(f"\npair, 300 cells, D 60: fdasrsf DP2 {theirs_s * 1e3:.0f} ms, ours / 20: x {20 * theirs_s / ours_s:.0f}")
    assert 20 * theirs_s / ours_s > 250


def repeat(work, times):
    for _ in range(times):
        work()


def worth(q1, q2, gamma):
    """The inner product of q1 with q2 warped by a path on the grid."""
    from emulator.geometry.elastic import warped_numpy

    return float(np.sum(q1 * warped_numpy(q2[None], gamma[None])[0])) / len(q1)


def test_a_pair_against_the_arithmetic_it_needs():
    _, (q1, q2) = fields(2, seed=0)
    kernel = q1 @ q2.T
    whole, path = elastic.optimum(kernel)
    pruned, same = elastic.optimum(kernel, (elastic.energy(q1), elastic.energy(q2)))
    assert pruned == whole and np.array_equal(path, same)
    n, dimension = q1.shape
    least_s = (0.75 * n * n * len(elastic.moves().tap_row) + n * n * dimension) / multiply_adds_per_s()
    rows_s, all_s = (
        taken / 10
        for taken in best_s(
            *(
                partial(repeat, work, 10)
                for work in (partial(elastic.optimum, kernel), partial(elastic.pair_warp, q1, q2))
            )
        )
    )
    print(
        f"\npair, 300 cells, D 60: every tap of every node that a path can reach, at the rate of a matrix product: "
        f"{least_s * 1e3:.2f} ms; without leaving nodes out {rows_s / least_s:.1f} x that, pair_warp as it is "
        f"{all_s / least_s:.1f} x ({all_s * 1e3:.2f} ms)"
    )
    assert all_s < rows_s and all_s < 3 * least_s


@pytest.mark.parametrize(("size", "n_cells", "at_least"), [("small", 100, 3.0), ("large", 300, 6.0)])
def test_the_compiled_rows_beat_the_numpy_rows(size, n_cells, at_least):
    _, (q1, q2) = fields(2, n_cells)
    kernel = q1 @ q2.T
    (fast, fast_path), (plain, plain_path) = elastic.optimum(kernel), elastic.optimum_numpy(kernel)
    assert fast == pytest.approx(plain, rel=1e-13) and np.array_equal(fast_path, plain_path)
    ours, numpys = best_s(partial(repeat, partial(elastic.optimum, kernel), 5), partial(elastic.optimum_numpy, kernel))
    print(f"\n{size}, {n_cells} cells, whole programme {ours / 5 * 1e3:.2f} ms, numpy x {5 * numpys / ours:.1f}")
    assert 5 * numpys / ours > at_least


def test_the_compiled_rows_beat_the_definition():
    _, (q1, q2) = fields(2, 20)
    kernel = q1 @ q2.T
    assert elastic.optimum(kernel)[0] == pytest.approx(naive_elastic(q1, q2)[0], rel=1e-12)
    ours, naive = best_s(
        partial(repeat, partial(elastic.optimum, kernel), 50), partial(naive_elastic, q1, q2), rounds=2
    )
    print(f"\nelastic pair, 20 cells: {ours / 50 * 1e6:.0f} us, naive x {50 * naive / ours:.0f}")
    assert 50 * naive / ours > 200


def test_60_repetitions_cost_little_more_than_their_pairs():
    sequences, q = fields(N_PAIRS)
    alignment = align(list(sequences), n_times=301)
    assert alignment.explained > 0.75
    rounds = len(alignment.history) + 1
    group_s, pairs_s = best_s(
        partial(align, list(sequences), n_times=301),
        lambda: [elastic.pair_warp(q[i], q[i - 1]) for i in range(N_PAIRS)],
    )
    print(f"\ngroup of 60 x 301 x 20: {group_s / pairs_s / rounds:.2f} x (60 x {rounds} rounds x a pair), target 1.5")
    assert group_s < 1.5 * rounds * pairs_s


def test_41_repetitions_of_101_postures_of_20_bones_align_in_a_second():
    sequences, _, _ = made_sequences(41, 101, seed=2)
    assert align(list(sequences)).explained > 0.75
    (taken,) = best_s(partial(align, list(sequences)), rounds=3)
    print(f"\ngroup of 41 x 101 x 20: {taken:.2f} s")
    assert taken < 1.0

"""Registration against its plain twins: the answer is asserted first, then the ratio. Run by ``make bench``."""

from time import perf_counter

import numpy as np
import pytest

from emulator import elastic
from emulator.align import align
from tests.made import made_sequences
from tests.naive import naive_elastic


def seconds(work, repeat=5):
    """The least time of some runs, after one to warm up."""
    work()
    taken = []
    for _ in range(repeat):
        start = perf_counter()
        work()
        taken.append(perf_counter() - start)
    return min(taken)


@pytest.mark.parametrize(("size", "n_cells", "at_least"), [("small", 100, 3.0), ("large", 300, 3.0)])
def test_the_compiled_rows_beat_the_numpy_rows(size, n_cells, at_least):
    sequences, _, base = made_sequences(2, n_cells + 1, seed=1)
    q1, q2 = elastic.tsrvf(sequences, base)
    kernel = q1 @ q2.T
    (fast, fast_path), (plain, plain_path) = elastic.optimum(kernel), elastic.optimum_numpy(kernel)
    assert fast == pytest.approx(plain, rel=1e-13) and np.array_equal(fast_path, plain_path)
    ours, numpys = seconds(lambda: elastic.optimum(kernel)), seconds(lambda: elastic.optimum_numpy(kernel), 2)
    print(f"\n{size}, {n_cells} cells {ours * 1e3:.2f} ms, numpy {numpys * 1e3:.1f} ms, x {numpys / ours:.1f}")
    assert numpys / ours > at_least


def test_the_compiled_rows_beat_the_definition():
    sequences, _, base = made_sequences(2, 21, seed=1)
    q1, q2 = elastic.tsrvf(sequences, base)
    start = perf_counter()
    naive, _ = naive_elastic(q1, q2)
    naive_s = perf_counter() - start
    assert elastic.optimum(q1 @ q2.T)[0] == pytest.approx(naive, rel=1e-12)
    ours = seconds(lambda: elastic.optimum(q1 @ q2.T))
    print(f"\nelastic pair, 20 cells: {ours * 1e6:.0f} us, naive {naive_s * 1e3:.0f} ms, x {naive_s / ours:.0f}")
    assert naive_s / ours > 200


def test_41_repetitions_of_101_postures_of_20_bones_align_in_two_seconds():
    sequences, _, _ = made_sequences(41, 101, seed=2)
    assert align(list(sequences)).explained > 0.75
    taken = seconds(lambda: align(list(sequences)), 2)
    print(f"\ngroup of 41 x 101 x 20: {taken:.2f} s")
    assert taken < 2.0

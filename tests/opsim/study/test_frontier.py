import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from opsim.kpi.catalogue import read_asked
from opsim.results import Result
from opsim.scenario.read import scenarios_in
from opsim.shipped import shipped_folder
from opsim.study import run_scenario
from opsim.study.compare import NotComparable
from opsim.study.pareto import dominates, frontier_of, non_dominated, placed

NUMBERS = st.one_of(st.integers(-3, 3).map(float), st.just(math.nan))
ROWS = st.lists(st.tuples(NUMBERS, NUMBERS), min_size=1, max_size=8)
MORE_LESS = np.array([1.0, -1.0])


def naive_front(rows):
    """By the definition: nobody is as good in both and better in one; who has a nan is not asked."""
    known = [row for row in rows if not any(map(math.isnan, row))]
    beaten = [any(o[0] >= r[0] and o[1] >= r[1] and o != r for o in known) for r in rows]
    return [row in known and not is_beaten for row, is_beaten in zip(rows, beaten)]


@given(ROWS)
def test_the_front_is_what_nothing_beats(rows):
    assert non_dominated(np.array(rows)).tolist() == naive_front(rows)


@given(ROWS)
def test_whoever_is_not_on_the_front_is_beaten_by_one_who_is(rows):
    values, front = np.array(rows), non_dominated(np.array(rows))
    ahead = dominates(values)
    for j in np.flatnonzero(~front & ~np.isnan(values).any(axis=1)):
        assert (ahead[:, j] & front).any()


@given(ROWS, st.randoms())
def test_the_order_of_variants_does_not_matter(rows, random):
    order = random.sample(range(len(rows)), len(rows))
    assert non_dominated(np.array(rows)[order]).tolist() == non_dominated(np.array(rows))[order].tolist()


def test_equal_variants_stand_on_the_front_together():
    assert non_dominated(np.array([[1.0, 2.0], [1.0, 2.0], [0.0, 2.0]])).tolist() == [True, True, False]


def test_who_is_shown_to_be_better_in_both_beats_clearly_and_who_is_not_does_not():
    luck = np.array([[0.0, 1.0, 2.0, 3.0, 4.0]] * 2)
    noise = np.array([[0.01, -0.02, 0.03, 0.0, -0.01], [0.02, 0.01, -0.01, -0.02, 0.03]])
    far = np.array([[3.0, -2.0, 4.0, -3.0, 1.0], [0.0] * 5])
    values = {
        "base": luck,
        "better": luck + np.array([[1.0], [-1.0]]) + noise,
        "maybe": luck + far + np.array([[0.0], [-0.5]]) + noise,
    }
    base, better, maybe = placed(values, MORE_LESS)
    assert better.on_front and base.clearly_behind == ("better",)
    assert base.behind == ("better", "maybe") and maybe.behind == ("better",) and maybe.clearly_behind == ()


def test_the_same_in_one_figure_and_better_in_the_other_is_clearly_better():
    luck = np.arange(10.0).reshape(2, 5)
    worse, better = placed({"worse": luck, "better": luck - [[0.0] * 5, [1.0, 1.1, 0.9, 1.0, 1.0]]}, MORE_LESS)
    assert worse.clearly_behind == ("better",) and better.on_front


def test_one_pair_of_replications_shows_nothing():
    worse, _ = placed({"worse": np.array([[1.0], [5.0]]), "better": np.array([[2.0], [4.0]])}, MORE_LESS)
    assert worse.behind == ("better",) and worse.clearly_behind == ()


def test_what_adding_in_another_order_leaves_makes_nobody_better():
    one = np.array([[0.1 + 0.2] * 3, [5.0] * 3])
    both = placed({"a": one, "b": np.array([[0.3] * 3, [5.0] * 3])}, MORE_LESS)
    assert all(point.on_front for point in both)


def test_a_variant_without_a_value_is_not_on_the_front_and_beats_nobody():
    nothing = np.array([[math.nan] * 3, [0.0] * 3])
    a, b = placed({"a": nothing, "b": np.arange(6.0).reshape(2, 3)}, MORE_LESS)
    assert not a.on_front and a.behind == () and b.on_front


class Made(Result):
    def kpis(self):
        return self.summary["table"]


def result(tmp_path, seed=1, **figures):
    table = {(kpi, *of): dict(enumerate(values)) for (kpi, *of), values in figures.pop("rows").items()}
    return Made(
        tmp_path, {"seed": seed, "kpis": [], "replications": 3, "window_s": [0, 3600], "table": table} | figures
    )


ROWS_OF = {
    ("throughput_per_h", "", "", "1/h"): [3.0, 4.0, 5.0],
    ("walked_m", "ana", "", "m"): [3.0, 4.0, 5.0],
    ("worker_states", "ana", "wait", "share"): [0.3, 0.4, 0.5],
}


@pytest.mark.parametrize(
    "x, y, said",
    [
        ("throughput_per_hour", "walked_m/ben", ["'throughput_per_h'", "did you mean 'walked_m/ana'"]),
        ("throughput_per_h", "worker_states/ana/wait", ["write 'more worker_states/ana/wait' or 'less"]),
        ("throughput_per_h", "throughput_per_h", ["two different figures"]),
        ("throughput_per_h", "trunk_beyond_60_min_per_h", ["'outputs'"]),
        ("less rest_taken_min_per_h", "stock", ["have none of it: there is one only where people rest by need"]),
    ],
)
def test_wrong_figures_are_all_said_at_once(tmp_path, x, y, said):
    results = {name: result(tmp_path, rows=ROWS_OF) for name in ("base", "near")}
    with pytest.raises(NotComparable) as error:
        frontier_of(results, read_asked(x), read_asked(y))
    assert all(words in str(error.value) for words in said)


def test_other_seeds_are_refused(tmp_path):
    x, y = read_asked("throughput_per_h"), read_asked("walked_m/ana")
    with pytest.raises(NotComparable, match="seeds 1, 2"):
        frontier_of({"a": result(tmp_path, rows=ROWS_OF), "b": result(tmp_path, 2, rows=ROWS_OF)}, x, y)


def test_a_variant_that_lacks_a_figure_is_named_and_the_others_stand_where_they_did(tmp_path):
    x, y = read_asked("throughput_per_h"), read_asked("walked_m/ana")
    some = {key: values for key, values in ROWS_OF.items() if key[0] != "walked_m"}
    better = {**ROWS_OF, ("walked_m", "ana", "", "m"): [1.0, 2.5, 2.0]}
    both = {"a": result(tmp_path, rows=ROWS_OF), "c": result(tmp_path, rows=better)}
    found = frontier_of({**both, "b": result(tmp_path, rows=some)}, x, y)
    assert found.absent == (("b", ("walked_m/ana",)),)
    assert found.points[:2] == frontier_of(both, x, y).points and found.points[0].behind == ("c",)
    assert not found.points[2].on_front and found.points[2].y.n == 0


POSTURES = """
opsim: 1
name: cell
run: {start: Mon 06:30, horizon: 3 min, seed: 3}
layout: {places: {here: [0 m, 0 m]}}
libraries: {bench: libraries/bench_work.npz}
tasks: {stoop: {emulator: bench/stoop, load: 12 kg}}
stations: {low: {at: here, tasks: [stoop], buffer: 2}}
products: {p: {route: [low]}}
release: {kind: saturated}
workers: {ana: {skills: {low: 1.0}}}
outputs: [throughput_per_h]
"""


@pytest.mark.parametrize("asked", ["", "frontier: [throughput_per_h, rula_from_5_min_per_h]"])
def test_what_a_frontier_asks_for_is_made_and_kept_in_the_summary_and_nothing_else_is(tmp_path, asked):
    loaded = scenarios_in(f"{POSTURES}{asked}\n".encode(), shipped_folder() / "made.yaml")
    found = run_scenario(next(iter(loaded.values())), folder=tmp_path, processes=1, replications=1).summary
    assert ("rula_from_5_min_per_h" in {row["kpi"] for row in found["kpis"]}) == ("frontier" in found) == bool(asked)


def test_nothing_is_clear_between_variants_that_are_open_for_different_hours(tmp_path):
    more = ROWS_OF | {
        ("throughput_per_h", "", "", "1/h"): [5.0, 6.01, 7.0],
        ("walked_m", "ana", "", "m"): [1.0, 2.01, 3.0],
    }
    results = {"a": result(tmp_path, rows=ROWS_OF), "b": result(tmp_path, rows=more)}
    asked = read_asked("throughput_per_h"), read_asked("walked_m/ana")
    assert frontier_of(results, *asked).points[0].clearly_behind == ("b",)
    results["b"] = result(tmp_path, rows=more, scheduled_h=0.5)
    other = frontier_of(results, *asked)
    assert other.other_hours and other.points[0].behind == ("b",) and other.points[0].clearly_behind == ()

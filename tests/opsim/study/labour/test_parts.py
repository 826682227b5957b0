"""Variance parts: a table by hand, a naive twin, how often intervals hold the truth, and what is refused.

Intervals of mean squares: what defines them, and of means over people and days.

Sources of variability: those that a scenario has on, and what switching them off leaves.
"""

import numpy as np
import pytest
from scipy.special import fdtri

from opsim.plan import compile_plan
from opsim.study.intervals import t_interval
from opsim.study.labour import variance_parts
from opsim.study.labour.budget import changes_off, sources_on
from opsim.study.labour.variance_components import (
    MeanSquare,
    difference_interval,
    mean_interval,
    squares_of,
    sum_interval,
)
from tests.opsim.study.labour.made import LINE, loaded, varied

TABLE = [[10.0, 12.0, 14.0], [13.0, 15.0, 20.0], [7.0, 6.0, 13.0]]


def naive_crossed(table):
    """Two-way analysis of variance with one value a cell, as in textbooks; (staffing, day, interaction)."""
    n, m = len(table), len(table[0])
    whole = sum(map(sum, table)) / (n * m)
    rows = [sum(row) / m for row in table]
    columns = [sum(row[j] for row in table) / n for j in range(m)]
    ms_rows = m * sum((row - whole) ** 2 for row in rows) / (n - 1)
    ms_columns = n * sum((column - whole) ** 2 for column in columns) / (m - 1)
    left = sum((table[i][j] - rows[i] - columns[j] + whole) ** 2 for i in range(n) for j in range(m))
    ms_left = left / ((n - 1) * (m - 1))
    return (ms_rows - ms_left) / m, (ms_columns - ms_left) / n, ms_left


def made(rng, shape, staffing, day, interaction, design="crossed", people=None):
    """(W, R) values of which the standard deviations are known."""
    n, m = shape
    own = rng.normal(size=n) if people is None else people(n)
    of_day = rng.normal(size=m) if design == "crossed" else rng.normal(size=shape)
    return 60 + own[:, None] * staffing + of_day * day + rng.normal(size=shape) * interaction


def test_a_table_by_hand():
    parts = variance_parts(TABLE)  # means of rows 12, 16, 26/3; of columns 10, 11, 47/3
    assert parts.mean == pytest.approx(110 / 9)
    assert [parts[name].estimate for name in ("staffing", "day", "interaction")] == pytest.approx(naive_crossed(TABLE))
    assert parts["run"].estimate == pytest.approx(parts["day"].estimate + parts["interaction"].estimate)
    assert sum(parts.share(part.name) for part in parts.parts) == pytest.approx(1)


def test_nested_is_the_analysis_within_and_between_rows():
    parts = variance_parts(TABLE, "nested")
    within = np.mean([np.var(row, ddof=1) for row in TABLE])
    between = 3 * np.var(np.mean(TABLE, axis=1), ddof=1)
    assert parts["run"].estimate == pytest.approx(within)
    assert parts["staffing"].estimate == pytest.approx((between - within) / 3)
    assert [part.name for part in parts.parts] == ["staffing", "run"]


def test_luck_that_is_the_same_for_all_is_the_day_alone():
    parts = variance_parts(np.tile([1.0, 5.0, 2.0], (4, 1)))
    assert parts["interaction"].estimate == pytest.approx(0, abs=1e-12)
    assert parts["staffing"].estimate == pytest.approx(0, abs=1e-12)
    assert parts["day"].estimate == pytest.approx(np.var([1, 5, 2], ddof=1))


def test_an_estimate_below_zero_is_told():
    parts = variance_parts([[1.0, 2.0], [2.0, 1.0]])
    assert parts["staffing"].truncated and parts["staffing"].estimate == -0.5
    assert (parts["staffing"].sd, parts["staffing"].low) == (0, 0)


def test_the_interval_of_the_interaction_is_chi_square():
    from scipy.special import chdtri

    part = variance_parts(TABLE)["interaction"]
    assert part.low == pytest.approx(part.estimate * 4 / chdtri(4, 0.025))
    assert part.high == pytest.approx(part.estimate * 4 / chdtri(4, 0.975))


COVERAGE = [
    ("crossed", (40, 4), 1.0, 0.3, 0.3),
    ("crossed", (40, 4), 0.3, 1.0, 0.3),
    ("crossed", (10, 3), 1.0, 1.0, 1.0),
    ("crossed", (20, 2), 0.1, 0.1, 1.0),
    ("nested", (40, 2), 1.0, 0.0, 0.8),
]


@pytest.mark.parametrize(("design", "shape", "staffing", "day", "interaction"), COVERAGE)
def test_intervals_hold_the_truth_as_often_as_they_say(design, shape, staffing, day, interaction):
    rng, n = np.random.default_rng(5), 500
    truth = {"staffing": staffing**2, "day": day**2, "interaction": interaction**2, "run": day**2 + interaction**2}
    hits = dict.fromkeys(truth, 0)
    for _ in range(n):
        parts = variance_parts(made(rng, shape, staffing, day, interaction, design), design)
        for name in {*(part.name for part in parts.parts), "run"}:
            hits[name] += parts[name].low <= truth[name] <= parts[name].high
    for name in {*(part.name for part in parts.parts), "run"}:
        assert hits[name] / n > 0.95 - 3 * (0.95 * 0.05 / n) ** 0.5, name


def test_people_of_whom_a_few_are_far_out_are_covered_nearly_as_often():
    rng, n = np.random.default_rng(5), 500
    skewed = lambda w: (rng.gamma(10, size=w) - 10) / 10**0.5  # noqa: E731
    hits = 0
    for _ in range(n):
        part = variance_parts(made(rng, (40, 4), 1.0, 0.3, 0.3, people=skewed))["staffing"]
        hits += part.low <= 1 <= part.high
    assert hits / n > 0.90


@pytest.mark.parametrize(("table", "words"), [
    ([[1.0, 2.0]], "one workforce"),
    ([[1.0], [2.0]], "cannot be told apart"),
    ([[1.0, np.nan], [2.0, 3.0]], "1 of 4 values are missing"),
    ([1.0, 2.0], "1 dimensions"),
])  # fmt: skip
def test_what_cannot_be_split_is_refused_with_the_reason(table, words):
    with pytest.raises(ValueError, match=words):
        variance_parts(table)


def test_an_unknown_design_is_refused():
    with pytest.raises(ValueError, match="known: crossed, nested"):
        variance_parts(TABLE, "crosed")


@pytest.mark.parametrize(("df1", "df2"), [(9, 20), (39, 117), (3, 4)])
def test_a_difference_touches_zero_where_the_f_test_does(df1, df2):
    just = fdtri(df1, df2, 0.975)
    assert difference_interval(MeanSquare(just, df1), MeanSquare(1.0, df2))[0] == pytest.approx(0, abs=1e-9)
    just = fdtri(df1, df2, 0.025)
    assert difference_interval(MeanSquare(just, df1), MeanSquare(1.0, df2))[1] == pytest.approx(0, abs=1e-9)


def test_a_difference_from_next_to_nothing_is_the_chi_square_interval():
    low, high = difference_interval(MeanSquare(2.0, 12), MeanSquare(1e-12, 30))
    assert (low, high) == pytest.approx(sum_interval([(1.0, MeanSquare(2.0, 12))]), rel=1e-6)


def test_squares_add_up_to_the_sum_of_squares():
    table = np.random.default_rng(3).normal(size=(6, 4))
    found = squares_of(table, True)
    total = 5 * found.rows.value + found.columns.value * 3 + found.rest.value * 15
    assert total == pytest.approx(np.sum((table - table.mean()) ** 2))


def test_tails_longer_than_normal_cost_degrees_of_freedom():
    few_odd = np.tile(np.r_[np.zeros(19), 10.0][:, None], (1, 3))
    assert squares_of(few_odd, True).rows.df < 3
    assert squares_of(np.tile(np.arange(20.0)[:, None], (1, 3)), True).rows.df == 19


def test_nested_means_are_student_t_of_the_rows():
    table = np.arange(12.0).reshape(6, 2)
    by_rows = t_interval(table.mean(axis=1))
    found = mean_interval(table, crossed=False)
    assert (found.mean, found.half_width) == pytest.approx((by_rows.mean, by_rows.half_width))


@pytest.mark.parametrize(("shape", "staffing", "day", "interaction"), [
    ((40, 4), 1.0, 0.3, 0.3), ((40, 4), 0.2, 1.0, 0.3), ((10, 5), 1.0, 1.0, 1.0), ((20, 3), 0.0, 0.0, 1.0),
])  # fmt: skip
def test_the_mean_is_held_as_often_as_is_said(shape, staffing, day, interaction):
    rng, n = np.random.default_rng(8), 500
    hits = 0
    for _ in range(n):
        found = mean_interval(made(rng, shape, staffing, day, interaction), crossed=True)
        hits += found.low <= 60 <= found.high
    assert hits / n > 0.95 - 3 * (0.95 * 0.05 / n) ** 0.5


def test_what_never_varies_is_known():
    assert mean_interval(np.full((4, 3), 7.0), crossed=True).half_width == 0


ALL = [
    *("between workers", "within workers", "skill ratings", "pace", "learning", "forgetting", "fatigue", "absence"),
    "breaks",
]


def test_what_a_scenario_has_on_is_found(tmp_path):
    assert [one.name for one in sources_on(loaded(tmp_path))] == ALL


def test_what_is_off_already_is_no_source(tmp_path):
    text = LINE.replace("seed: 5}", "seed: 5, variability: between_only}").replace("1.2", "1.0")
    text = text.partition("human:")[0] + "outputs: [throughput_per_h]"
    assert [one.name for one in sources_on(loaded(tmp_path, text))] == ["between workers", "absence", "breaks"]


def test_switching_off_keeps_mean_times_where_it_says_so(tmp_path):
    line = varied(tmp_path)
    base = line.with_changes({})
    full = compile_plan(base)
    for name in ("between workers", "within workers"):
        plan = compile_plan(line.with_changes(changes_off(base, [name])))
        assert [t.model.mean_duration_s() for t in plan.tasks] == pytest.approx(
            [t.model.mean_duration_s() for t in full.tasks]
        )


def test_both_switches_of_people_are_one_switch(tmp_path):
    assert changes_off(loaded(tmp_path), ["between workers", "within workers"]) == {"run.variability": "none"}


def test_ratings_off_is_the_pace_of_which_the_mean_time_is_theirs(tmp_path):
    base = loaded(tmp_path)
    workers = changes_off(base, ["skill ratings"])["workers"]
    level = 2 / (1 / 1.0 + 1 / 1.2)
    assert [workers[name]["skills"]["saw"] for name in ("ana", "ben")] == pytest.approx([level, level])
    assert workers["cem"] == base.resolved["workers"]["cem"]


def test_everything_off_is_a_floor_on_which_nothing_varies(tmp_path):
    line = varied(tmp_path)
    off = line.with_changes(changes_off(line.with_changes({}), ALL))
    assert sources_on(off) == ()


@pytest.mark.parametrize("name", ALL)
def test_each_can_be_switched_off_and_is_then_gone(tmp_path, name):
    line = varied(tmp_path)
    off = line.with_changes(changes_off(line.with_changes({}), [name]))
    left = [one.name for one in sources_on(off)]
    assert name not in left
    assert set(ALL) - set(left) <= {name, "forgetting" if name == "learning" else name}


def test_people_of_a_workforce_come_to_every_shift_too(tmp_path):
    text = LINE.partition("workers:")[0] + "workforce: {n: 3, shift: early, absence: 0.2}\n"
    line = varied(tmp_path, text)
    base = line.with_changes({})
    off = line.with_changes(changes_off(base, ["absence"]))
    assert [worker.absence for worker in base.scenario.workers.values()] == [0.2] * 3
    assert [worker.absence for worker in off.scenario.workers.values()] == [0] * 3

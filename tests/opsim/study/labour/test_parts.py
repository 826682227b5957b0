"""Variance parts: a table by hand, a naive twin, how often intervals hold the truth, and what is refused."""

import numpy as np
import pytest

from opsim.study.labour import variance_parts

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

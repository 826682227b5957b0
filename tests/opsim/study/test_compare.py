import json
import re
from dataclasses import dataclass

import numpy as np
import pytest
from plans import line, loaded

from opsim.kpi.catalogue import KPIS
from opsim.scenario import read_scenarios
from opsim.scenario.json_schema import schema_text
from opsim.study import run_scenario
from opsim.study.compare import ONLY_WHERE, NotComparable, compare, holm, paired, remedy
from opsim.study.intervals import holm as holm_of_paired
from opsim.study.intervals import paired as paired_of_paired
from opsim.study.intervals import paired_with_each, t_interval


@dataclass(frozen=True)
class Made:
    """What ``compare`` needs of a Result."""

    summary: dict
    table: dict

    def kpis(self):
        return self.table


def made(seed=1, **figures):
    table = {(kpi, "", "", "1/h"): dict(enumerate(values)) for kpi, values in figures.items()}
    return Made({"seed": seed, "kpis": [{"kpi": kpi, "headline": True} for kpi in figures]}, table)


def test_the_difference_is_that_of_the_pairs():
    base, near = [10.0, 12.0, 11.0, 13.0], [11.0, 13.5, 12.0, 14.1]
    (found,) = compare({"base": made(out=base), "near": made(out=near)}).differences
    assert found.interval == t_interval(np.subtract(near, base))
    assert (found.base, found.mean) == (11.5, pytest.approx(12.65))
    assert found.verdict == "higher"


def test_a_known_paired_t_test():
    """Student 1908, extra hours of sleep by two drugs: t = 4.0621 with 9 degrees of freedom, p = 0.002833."""
    one = [0.7, -1.6, -0.2, -1.2, -0.1, 3.4, 3.7, 0.8, 0.0, 2.0]
    two = [1.9, 0.8, 1.1, 0.1, -0.1, 4.4, 5.5, 1.6, 4.6, 3.4]
    interval, p, _ = paired(two, one)
    assert interval.mean == pytest.approx(1.58)
    assert (interval.low, interval.high) == (pytest.approx(0.7001142), pytest.approx(2.4598858))
    assert p == pytest.approx(0.002833, abs=5e-7)


def test_the_variance_ratio_is_one_for_independent_runs_and_large_for_alike_ones():
    rng = np.random.default_rng(0)
    a, b = rng.normal(size=(2, 20_000))
    assert paired(a, b)[2] == pytest.approx(1.0, abs=0.05)
    assert paired(a + 0.1 * b, a)[2] == pytest.approx(201, rel=0.05)


def test_identical_runs_differ_by_exactly_nothing_and_it_is_said():
    values = [0.1, 0.2, 0.30000000000000004]
    (found,) = compare({"base": made(out=values), "same": made(out=values)}).differences
    assert (found.interval.mean, found.interval.half_width) == (0, 0)
    assert found.verdict == "identical" and found.p_together == 1


def test_differences_of_rounding_only_are_identical_and_small_true_ones_are_not():
    values = np.array([1e4 / 3, 2e4 / 7, 1e4 / 9])
    rounded = values * (1 + np.array([2e-16, -4e-16, 3e-14]))
    results = {"base": made(out=values), "rounded": made(out=rounded), "small": made(out=values + 1e-4)}
    same, small = compare(results).differences
    assert same.verdict == "identical" and same.interval.half_width == 0 and same.variance_ratio is None
    assert small.verdict == "too few replications to say" and small.interval.mean > 0


def test_identical_figures_do_not_count_among_the_comparisons():
    base, near = [10.0, 12.0, 11.0, 13.0], [11.0, 13.5, 12.0, 14.1]
    alone = compare({"base": made(out=base), "near": made(out=near)})
    copies = {f"same{i}": made(out=[value * (1 + 1e-15) for value in base]) for i in range(9)}
    among = compare({"base": made(out=base), "near": made(out=near), **copies})
    assert among.differences[0].p_together == alone.differences[0].p_together
    assert "all comparisons together (1)" in among.words[1]


def test_the_same_step_in_few_replications_that_vary_says_nothing_and_in_many_or_without_luck_it_is_certain():
    """Jobs of three runs, 450, 453, 456 and 9 less of each: no spread of three small counts is no proof."""
    jobs, many = np.array([450.0, 453.0, 456.0]), np.arange(450.0, 462.0)
    results = {"base": made(out=jobs), "less": made(out=jobs - 9), "other": made(out=jobs + np.array([1, 2, 1.5]))}
    less, _ = compare(results).differences
    assert less.verdict == "too few replications to say" and np.isnan(less.p) and less.interval.half_width == 0
    assert "all comparisons together (1)" in compare(results).words[1]
    for base, of in ((many, many - 9), (np.full(3, 60.0), np.full(3, 51.0))):
        (found,) = compare({"base": made(out=base), "less": made(out=of)}).differences
        assert found.verdict == "lower" and found.p == 0 and found.interval.half_width == 0


def open_for(hours, **figures):
    one = made(**figures)
    return Made({**one.summary, "window_s": [0, 24 * 3600], **hours}, one.table)


def test_what_comes_out_per_scheduled_hour_is_not_judged_between_variants_of_other_hours():
    night = open_for({}, throughput_per_h=[2.3, 2.4, 2.5], throughput_per_calendar_h=[2.3, 2.4, 2.5])
    days = {"throughput_per_h": [3.0, 3.1, 3.3], "throughput_per_calendar_h": [2.0, 2.1, 2.3]}
    two, same = (open_for({"scheduled_h": 16}, **days) for _ in range(2))
    two.summary["kpis"] = two.summary["kpis"][:1]  # nobody asks for the throughput per calendar hour
    found = compare({"base": two, "night": night, "same": same})
    assert {(d.variant, d.key[0]): d.verdict for d in found.differences} == {
        ("night", "throughput_per_h"): "other hours",
        ("night", "throughput_per_calendar_h"): "higher",
        ("same", "throughput_per_h"): "identical",
        ("same", "throughput_per_calendar_h"): "identical",
    }
    assert "all comparisons together (1)" in found.words[1]
    assert "(base 16 h, night 24 h)" in found.words[-1] and "per calendar hour" in found.words[-1]


def test_variants_of_the_same_hours_are_judged_per_scheduled_hour():
    found = compare(
        {name: open_for({"scheduled_h": 8}, throughput_per_h=v) for name, v in (("base", [1, 1]), ("b", [2, 2]))}
    )
    assert [d.verdict for d in found.differences] == ["higher"] and "Other hours" not in "".join(found.words)


def test_one_replication_says_nothing_and_nothing_observed_is_said():
    (found,) = compare({"base": made(out=[1.0]), "more": made(out=[2.0])}).differences
    assert found.verdict == "one replication says nothing" and found.interval.mean == 1
    (found,) = compare({"base": made(out=[np.nan] * 3), "more": made(out=[2.0] * 3)}).differences
    assert found.verdict == "nothing observed"


def test_a_pair_of_which_one_is_unknown_is_left_out():
    (found,) = compare({"base": made(out=[1.0, np.nan, 3.0]), "b": made(out=[2.0, 5.0, 4.5])}).differences
    assert found.interval.n == 2 and found.base == 2.0


def test_only_replications_that_all_variants_have_are_paired():
    found = compare({"base": made(out=[1.0, 2.0, 3.0]), "b": made(out=[2.0, 1.0])})
    assert found.n == 2 and found.differences[0].interval.mean == 0


def test_holm_is_the_textbook_procedure():
    assert holm([0.01, 0.04, 0.03, 0.005]) == pytest.approx([0.03, 0.06, 0.06, 0.02])
    assert holm([0.6, 0.7]) == pytest.approx([1.0, 1.0])
    assert holm([np.nan, 0.02])[1] == 0.02 and np.isnan(holm([np.nan, 0.02])[0])


def test_many_comparisons_ask_for_more():
    rng = np.random.default_rng(3)
    base = rng.normal(size=10)
    weak = base + 0.35 + rng.normal(0, 0.4, 10)
    alone = compare({"base": made(out=base), "weak": made(out=weak)}).differences[0]
    others = {f"v{i}": made(out=base + rng.normal(0, 0.4, 10)) for i in range(20)}
    among = compare({"base": made(out=base), "weak": made(out=weak), **others}).differences[0]
    assert alone.p == among.p and alone.verdict == "higher" and among.verdict == "not proven"


@pytest.mark.parametrize(
    "results, base, kpis, said",
    [
        ({"base": made(out=[1.0])}, "base", (), "nothing to compare"),
        ({"base": made(out=[1.0]), "near": made(2, out=[1.0])}, "base", (), "near has seed 2"),
        ({"base": made(out=[1.0]), "near": made(out=[1.0])}, "bsae", (), "did you mean 'base'"),
        ({"base": made(output=[1.0]), "near": made(output=[1.0])}, "base", ("outptu",), "did you mean 'output'"),
    ],
)
def test_what_cannot_be_compared_is_said(results, base, kpis, said):
    with pytest.raises(NotComparable, match=said):
        compare(results, base, kpis)


VARIANTS = """
  faster: {tasks.drill.mean: 57.142857 s}
  idle:
    workers.zoe: {home: third, skills: {storing: 1.0}}
    tasks.store: {fixed: 1 s}
    stations.storing: {at: third, tasks: [store]}
"""


@pytest.fixture(scope="module")
def serial_line(tmp_path_factory):
    """The shipped line with one station 5 % faster, and with a worker more who has nothing to do."""
    from opsim.shipped import shipped_folder

    text = (shipped_folder() / "serial_line.yaml").read_text()
    text = text[: text.index("overrides:")] + "overrides:" + VARIANTS
    text += "scenarios: {base: [], faster: [faster], idle: [idle]}\noutputs: [throughput_per_h, time_in_system_s]\n"
    folder = tmp_path_factory.mktemp("serial")
    (folder / "line.yaml").write_text(text)
    variants = read_scenarios(folder / "line.yaml")
    return {
        name: run_scenario(one, folder=folder / name, processes=1, replications=20) for name, one in variants.items()
    }


@pytest.mark.slow
def test_common_random_numbers_find_a_station_5_percent_faster(serial_line, capsys):
    found = {d.key[0]: d for d in compare(serial_line).differences if d.variant == "faster"}
    throughput = found["throughput_per_h"]
    with capsys.disabled():
        print(f"\n5 % faster: {throughput.interval}, variance ratio {throughput.variance_ratio:.1f}", end="")
    assert throughput.verdict == "higher" and throughput.variance_ratio >= 10


@pytest.mark.slow
def test_an_idle_worker_more_changes_nothing_at_all(serial_line):
    found = [d for d in compare(serial_line).differences if d.variant == "idle"]
    assert len(found) == 2 and all(d.verdict == "identical" and d.interval.mean == 0 for d in found)


def test_results_that_are_no_numbers_are_refused_with_their_place(tmp_path):
    from opsim.results import Result, variants_in

    with pytest.raises(ValueError, match="no results here"):
        variants_in(tmp_path)
    (tmp_path / "summary.json").write_text(json.dumps([1]))
    with pytest.raises(ValueError, match=r"summary.json: not the summary"):
        Result.load(tmp_path)


def test_variants_of_another_scenario_or_window_are_not_compared(tmp_path):
    folders = [
        run_scenario(loaded(line(2, 1, horizon=horizon)), folder=tmp_path / horizon, processes=1, replications=2)
        for horizon in ("1500 s", "2000 s")
    ]
    with pytest.raises(NotComparable, match="the window of base"):
        compare(dict(zip(("base", "long"), folders)))


def paired_made(seed):
    """Figures of 40 variants, 2 figures each, in 6 to 14 replications: some alike, some unknown, some constant."""
    rng = np.random.default_rng(seed)
    n = int(rng.integers(6, 15))
    base = rng.normal(100, 5, (2, n))
    values = base + rng.normal(0, 1, (40, 2, n)) + rng.normal(0, 1, (40, 2, 1))
    values[3] = base
    values[4] = base * (1 + 1e-14)
    values[5] = base + 2
    values[6, 0], values[7] = 7.0, np.nan
    values[8, :, ::2] = np.nan
    values[9, 1, 1:] = np.nan
    return (base if seed % 2 else np.full_like(base, 9.0)), values


@pytest.mark.parametrize("seed", range(6))
def test_one_with_each_is_one_by_one(seed):
    one, others = paired_made(seed)
    mean, p, same = paired_with_each(one, others)
    for i, other in enumerate(others):
        for figure in (0, 1):
            interval, alone, _ = paired_of_paired(one[figure], other[figure])
            assert mean[i, figure] == pytest.approx(interval.mean, rel=1e-9, abs=1e-12, nan_ok=True)
            assert p[i, figure] == pytest.approx(alone, rel=1e-6, abs=1e-12, nan_ok=True)
            assert same[i, figure] == (interval.n > 0 and interval.mean == 0 and interval.sd == 0)


def test_none_to_compare_with_is_nothing():
    mean, p, same = paired_with_each(np.ones((2, 5)), np.ones((0, 2, 5)))
    assert mean.shape == p.shape == same.shape == (0, 2) and holm_of_paired([]).size == 0


def test_nobody_is_sent_to_the_name_he_wrote():
    assert all(f"did you mean {kpi!r}" not in remedy(kpi, {*KPIS} - {kpi}) for kpi in KPIS)


@pytest.mark.parametrize(
    "kpi, said",
    [
        ("rest_taken_min_per_h", "people rest by need ('human: rest')"),
        ("overtime_h", "workers have shifts"),
        ("stock", "these results have none of it: there is one only where there are 'stores'"),
        ("down_s", "stations have 'breakdowns' or 'maintenance'"),
        ("rula_mean", "'outputs' list it"),
        ("throughput_per_hour", "did you mean 'throughput_per_h'?"),
    ],
)
def test_why_there_is_none_of_a_figure_is_said(kpi, said):
    assert remedy(kpi, ("throughput_per_h", "walked_m")).endswith(said) or said in remedy(kpi, ("throughput_per_h",))


def test_only_figures_have_conditions_and_these_are_words_of_the_language():
    assert set(ONLY_WHERE) <= set(KPIS)
    said = {word for why in ONLY_WHERE.values() for word in re.findall(r"'(\w+)", why)}
    assert {word for word in said if f'"{word}": {{' not in schema_text()} == set()

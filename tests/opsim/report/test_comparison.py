import math
import re
from dataclasses import replace

import numpy as np
import pytest

from opsim.report.comparison import MOST_ROWS, comparison_cells, comparison_html, screen_table
from opsim.report.comparison_sentences import amount, answer, best_of, signed, spoken_name
from opsim.report.plot.svg_chart import intervals_svg
from opsim.study.compare import Comparison, Difference, paired
from opsim.study.intervals import Interval

HARM = '<script>alert("x")</script>'


def difference(mean=1.0, half=0.25, sd=0.5, variant="near", p=0.001):
    key = ("throughput_per_h", HARM, "", "1/h")
    return Difference(variant, key, 20.0, 20.0 + mean, Interval(mean, half, sd, 10), p, p, 12.345)


def test_a_difference_shows_as_many_digits_as_its_interval_supports():
    cells = comparison_cells(difference())
    assert cells["difference"] == "1.00 ± 0.25" and cells["base"] == "20.00" and cells["pairing"] == "12.3"
    assert cells["relative"] == "5.0 %" and cells["verdict"] == "higher"


def test_identical_is_said_and_no_nan_is_shown():
    cells = comparison_cells(difference(0.0, 0.0, 0.0, p=1.0))
    assert cells["difference"] == "0" and cells["verdict"] == "identical"
    unknown = comparison_cells(difference(math.nan, math.nan, math.nan, p=math.nan))
    assert "nan" not in "".join({**cells, **unknown}.values())


def test_no_name_becomes_markup():
    page = comparison_html(Comparison("base", 1, 10, (difference(variant=HARM),)), HARM)
    assert "<script>" not in page and "&lt;script&gt;" in page


def test_a_picture_has_a_dot_a_variant_and_a_line_at_zero():
    svg = intervals_svg(
        [("a", -1.0, 0.5, 2.0, "no clear difference"), ("b", math.nan, 3.0, math.nan, "one")], "per hour"
    )
    assert svg.count("<circle") == 2 and svg.count('stroke-width="3"') == 1 and svg.count('stroke-width="1.5"') == 1
    x = [float(at) for at in re.findall(r'<circle cx="([\d.]+)"', svg)]
    assert x[0] < x[1]


def test_a_picture_of_nothing_but_zero_is_still_a_picture():
    assert "nan" not in intervals_svg([("same", 0.0, 0.0, 0.0, "identical")], "min")


def test_a_difference_far_below_what_it_is_of_shows_no_digits_of_its_own():
    """Rest of 2.756183 and 2.756181 minutes: a difference of a millionth of it is 0 to whoever reads."""
    base = np.array([2.756183, 2.756184, 2.756182])
    interval, p, ratio = paired(base - [2e-6, 1e-6, 3e-6], base)
    cells = comparison_cells(Difference("b", ("x", "", "", "min/h"), 2.756183, 2.756181, interval, p, p, ratio))
    assert (cells["base"], cells["difference"], cells["relative"]) == ("2.7562", "0.0000 ± 0.0001", "0.00 %")


OUT, STAY, STATE = ("throughput_per_h", "", "", "1/h"), ("time_in_system_s", "", "", "s"), ("walked_m", "ana", "", "m")


def comparison_words_difference(variant="near", key=OUT, by=1.0, half=0.25, base=20.0, p=0.001, n=10):
    sd = half if by or half else 0.0
    return Difference(variant, key, base, base + by, Interval(by, half, sd, n), p, p, 4.0)


def said(*differences, **how):
    return answer(Comparison("base", 7, 10, differences, **how))


def test_what_is_better_and_worse_is_said_with_interval_and_per_cent():
    assert said(comparison_words_difference(), comparison_words_difference(key=STAY, by=4.0, base=80.0)) == [
        "near is better in throughput (+1.00 ± 0.25 per hour, +5.0 %), "
        "worse in time in system (+4.00 ± 0.25 s, +5.00 %)."
    ]


def test_what_is_not_clear_and_what_is_the_same_is_said():
    (sentence,) = said(
        comparison_words_difference(by=0.1, p=0.4), comparison_words_difference(key=STAY, by=0.0, half=0.0, p=1.0)
    )
    assert sentence.startswith("near: no clear difference in throughput (+0.10 ± 0.25 per hour, +0.5 %).")
    assert sentence.endswith("The same in every replication: time in system.")
    same = [comparison_words_difference(name, by=0.0, half=0.0, p=1.0) for name in ("a", "b")]
    assert said(*same) == ["a and b are identical to base in every replication."]


def test_variants_with_something_clear_come_first_and_few_replications_are_named():
    few = comparison_words_difference("few", p=np.nan)
    first, second = said(few, comparison_words_difference("near"))
    assert first.startswith("near is better")
    assert second == "few: too few replications, which all differ by as much, to say anything of throughput."


def test_three_figures_are_named_and_the_others_counted():
    keys = [
        OUT,
        STAY,
        ("work_in_progress", "", "", "jobs"),
        ("lost_per_h", "", "", "1/h"),
        ("scrap_per_h", "", "", "1/h"),
    ]
    (sentence,) = said(*(comparison_words_difference(key=key, by=1.0 if key is OUT else -1.0) for key in keys))
    assert sentence.count("±") == 3 and sentence.endswith("and 2 more figures.")


def test_figures_of_one_worker_are_spoken_of_only_where_nothing_else_is_asked():
    assert "ana" not in said(comparison_words_difference(), comparison_words_difference(key=STATE))[0]
    assert "walked of ana (+1.00 ± 0.25 m" in said(comparison_words_difference(key=STATE))[0]


def test_a_share_differs_by_percentage_points_and_hours_are_named():
    share = comparison_words_difference(key=("lost_share", "", "", "share"), by=0.02, half=0.005, base=0.1)
    assert amount(share, [share]) == "+2.0 ± 0.5 percentage points"
    page = comparison_html(Comparison("base", 1, 10, (share,)), "Shares")
    assert '10.0 %</td><td class="number">12.0 %</td><td class="number mean">2.0 ± 0.5</td>' in page
    assert '<td class="unit">percentage points</td><td class="number"></td>' in page
    assert screen_table(Comparison("base", 1, 10, (share,)), 140).rows[0][1:] == ("10.0", "+2.0 ± 0.5 points *")
    assert spoken_name(comparison_words_difference(), hours=True) == "throughput per scheduled hour"
    assert [signed(text) for text in ("0", "0.00 ± 0.15", "0.03 ± 0.04", "\N{MINUS SIGN}4")] == [
        *("0", "0.00 ± 0.15", "+0.03 ± 0.04", "\N{MINUS SIGN}4"),
    ]


def test_the_base_is_rounded_once_for_all_variants():
    rough, exact = (comparison_words_difference(name, half=half, base=28.85) for name, half in (("a", 2.0), ("b", 0.2)))
    page = comparison_html(Comparison("base", 1, 10, (rough, exact)), "Bases")
    assert page.count('<td class="number">28.85</td>') == 2 and "base: 28.85 per hour" in page
    assert screen_table(Comparison("base", 1, 10, (rough, exact)), 140).rows[0][1] == "28.85"


def many(n):
    rng = np.random.default_rng(1)
    by = rng.normal(0, 2, n)
    made = [
        comparison_words_difference(f"v{i}", key, b, p=0.001 if abs(b) > 2 else 0.5)
        for key in (OUT, STAY)
        for i, b in enumerate(by)
    ]
    return Comparison("base", 7, 10, tuple(made)), by


def test_many_variants_are_counted_and_the_best_named():
    comparison, by = many(1000)
    first, second, best = answer(comparison)
    assert (
        f"In throughput {np.sum(by > 2)} of 1,000 variants are clearly better than base and {np.sum(by < -2)}" in first
    )
    assert f"In time in system {np.sum(by < -2)} of 1,000 variants are clearly better" in second
    assert f"Best in throughput is v{np.argmax(by)} (+" in best
    assert [d.variant for d in best_of(comparison.differences, 2)] == [f"v{i}" for i in np.argsort(-by)[:2]]


def test_the_page_of_many_variants_shows_the_best_and_the_worst_and_says_so():
    comparison, by = many(1000)
    page = comparison_html(comparison, "Many")
    assert page.count("<tr><td>") == 2 * MOST_ROWS and "the best and the worst of 1000 variants" in page
    assert f"<td>v{np.argmax(by)}</td>" in page and f"<td>v{np.argmin(by)}</td>" in page


def test_the_page_begins_with_the_answer():
    page = comparison_html(Comparison("base", 7, 10, (comparison_words_difference(),)), "Line")
    assert page.index("near is better in throughput") < page.index("<table>") < page.index("How to read this")


@pytest.mark.parametrize("width", [80, 100, 140])
def test_a_table_of_many_variants_has_the_base_and_the_best_ten(width):
    table = screen_table(many(1000)[0], width)
    assert len(table.rows) == 11 and table.rows[0][0] == "base" and len(table.columns) <= 1 + 4
    assert table.left_out[0] == "The best 10 of 1,000 variants in throughput."


def test_few_variants_stand_beside_each_other_where_there_is_room():
    comparison = Comparison("base", 7, 10, tuple(comparison_words_difference(name) for name in ("a", "b", "c", "d")))
    assert screen_table(comparison, 140).columns == ("figure", "base", "a", "b", "c", "d")
    assert screen_table(comparison, 80).columns[0] == "variant"
    assert screen_table(comparison, 140).rows == (
        ("Throughput (good units), per hour", "20.00", *["+1.00 ± 0.25 *"] * 4),
    )


def test_the_table_leaves_out_what_is_the_same_and_what_does_not_fit_and_says_so():
    same = comparison_words_difference(key=STAY, by=0.0, half=0.0, p=1.0)
    workers = [comparison_words_difference(key=("walked_m", f"w{i}", "", "m")) for i in range(30)]
    table = screen_table(Comparison("base", 7, 10, (*workers, comparison_words_difference(), same)), 140)
    assert len(table.rows) == 18 and table.rows[-1][0].startswith("Throughput") and table.rows[1][0] == "  w1"
    assert table.left_out == ("The same in all variants: time in system.", "13 more figures are in the page.")


def test_most_there_may_be_is_not_said_twice():
    rula = [("rula_from_7_min_per_h", "", part, "min/h") for part in ("", "at_most")]
    table = screen_table(Comparison("base", 7, 10, tuple(comparison_words_difference(key=key) for key in rula)), 140)
    assert len(table.rows) == 1


def alone(**how):
    return replace(comparison_words_difference(**how), p=0.01, p_together=0.2)


def test_what_is_clear_by_itself_but_not_among_all_comparisons_is_named_first_where_it_is_worse():
    rula = comparison_words_difference(key=("rula_from_5_min_per_h", "", "", "min/h"), by=-0.5, half=0.1, base=1.0)
    (sentence,) = said(alone(by=-8.0, half=3.0), rula, comparison_words_difference(key=STAY, by=0.1, p=0.5))
    assert sentence.startswith(
        "near looks worse in throughput (\N{MINUS SIGN}8.0 ± 3.0 per hour, \N{MINUS SIGN}40 %), but that is not proven "
        "with 3 comparisons held together. It is better in RULA 5 or more ("
    )
    assert sentence.endswith("No clear difference in time in system (+0.10 ± 0.25 s, +0.5 %).")
    gained = said(comparison_words_difference(), alone(key=STAY, by=-4.0, base=80.0))[0]
    assert gained.startswith("near is better in throughput") and "It looks better in time in system" in gained
    assert said(alone(variant="{x}"))[0].startswith("{x} looks better in throughput (+1.00 ± 0.25 per")


def test_no_sentence_puts_a_large_fall_of_the_output_behind_what_is_better():
    better = comparison_words_difference(key=STAY, by=-4.0, base=80.0)
    (clear,) = said(better, comparison_words_difference(by=-8.0, half=3.0))
    assert clear.startswith("near is worse in throughput (") and ", better in time in system (" in clear
    (unclear,) = said(better, comparison_words_difference(by=-8.0, half=9.0, p=0.07))
    assert "near: no clear difference in throughput" in unclear and "%). It is better in time in system (" in unclear


def test_the_table_and_its_words_mark_what_is_not_proven_and_only_then():
    comparison = Comparison("base", 7, 10, (alone(), comparison_words_difference(variant="far")))
    assert screen_table(comparison, 140).rows[0][2:] == ("+1.00 ± 0.25 (*)", "+1.00 ± 0.25 *")
    assert any(words.startswith("(*) ") for words in comparison.short_words)
    assert any(words.startswith("'not proven'") for words in comparison.words)
    assert "not proven" not in " ".join(Comparison("base", 7, 10, (comparison_words_difference(),)).words)

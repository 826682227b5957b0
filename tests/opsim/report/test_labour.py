"""What a labour study says, from made numbers: the sentences an engineer reads first.

What variability costs, from variants without it.
"""

from dataclasses import replace
from types import SimpleNamespace as Made

import numpy as np
import pytest
from plans import HERE

from opsim.kpi.targets import read_target
from opsim.report.material import Material
from opsim.report.numbers import ABSENT
from opsim.report.page import Grid, Panels, study_html
from opsim.report.sections import variability as budget
from opsim.report.sections.variability import budget_of
from opsim.report.studies.labour import answer, bought_table, labour_page, reading
from opsim.report.studies.labour_charts import bought_svg, budget_svg, day_svg, figure_name, parts_svg
from opsim.scenario.read import scenarios_in
from opsim.study import run_scenario
from opsim.study.intervals import Interval
from opsim.study.labour.budget import FigureBudget, VariabilitySource
from opsim.study.labour.daily_output import DayAsked, day_found
from opsim.study.labour.interventions import BoughtBack, Curve, Step
from opsim.study.labour.study import LabourFound, too_few_days
from opsim.study.labour.variance_components import variance_parts
from opsim.study.run import opened
from tests.opsim.report.made_material import texts

KEY = ("throughput_per_h", "", "", "1/h")
RNG = np.random.default_rng(7)
RATES = 3.7 * RNG.normal(size=(40, 1)) + 0.5 * RNG.normal(size=(1, 4)) + 0.5 * RNG.normal(size=(40, 4))
RATES = RATES - RATES.mean() + 61


def of(mean, half=0.5):
    return Interval(mean, half, half, 160)


def curve(name, kind, *gained):
    return Curve(name, kind, tuple(Step(n, of(g), of(g - 8.4)) for n, g in enumerate(gained, 1)))


def found(rates=RATES, curves=(), loss=8.4, target="480 a day"):
    parts = variance_parts(rates)
    on = (VariabilitySource("between workers", "alike", True), VariabilitySource("<i>pace</i>", "none"))
    numbers = {one.name: of(loss if one.keeps_mean else -1.0) for one in on}
    budget = FigureBudget(KEY, of(61.0), of(68.9), numbers, of(0.5), of(7.9), {})
    day = day_found(DayAsked(KEY[0], "", "", 8.0, 1, read_target(target)), KEY, rates, "crossed")
    bought = BoughtBack(of(loss), of(61 + loss), tuple(curves)) if curves else None
    return LabourFound("crossed", 40, 4, {KEY: parts}, day, on, (budget,), bought, ())


def test_the_answer_says_who_when_what_it_costs_what_buys_it_back_and_the_target():
    ways = (curve("more like ana", "workers", 5.0, 9.5), curve("skills more", "skills", 8.7, 9.9))
    said = " ".join(answer(found(curves=ways)))
    assert "Who is hired moves the output by ± 5 % (SD; 4.1 to 6.5 %; 97 % of the variance)" in said
    assert "the luck of the day by ± " in said
    assert "Differences between people cost 8.4 ± 0.5 an hour: 61.0 come out, and 69.4 would" in said
    assert "Two people more like ana or one skill more (two to be sure) buy it back." in said
    assert "You reach 480 a day with a chance of" in said
    assert "Days of 8 h: half of them come to" in said


def test_what_falls_short_says_how_much_of_it():
    said = " ".join(answer(found(curves=(curve("more like ana", "workers", 4.2, 4.2), curve("x", "skills", 0.1)))))
    assert "One person more like ana buys back 50 % of it." in said
    assert "One skill more buys nothing back that could be told from luck." in said


def test_no_loss_is_said_and_nothing_is_bought_back():
    said = answer(found(curves=(curve("more like ana", "workers", 1.0),), loss=0.2))
    assert "What differences between people cost cannot be told from nothing: +0.2 ± 0.5 an hour." in said
    assert not any("buy" in sentence for sentence in said)


def test_where_the_loss_may_be_nothing_no_share_of_it_is_told_and_nothing_is_enough():
    table = bought_table(found(curves=(curve("more like ana", "workers", 1.0),), loss=0.2))
    assert "enough" not in table.columns and table.rows[0][table.columns.index("of the loss")] == ABSENT
    table = bought_table(found(curves=(curve("more like ana", "workers", 4.2),)))
    assert "enough" in table.columns and table.rows[0][table.columns.index("of the loss")] == "50 %"


def test_two_days_for_all_are_warned_of_on_the_screen_and_on_the_page():
    assert too_few_days("crossed", 3) == too_few_days("nested", 2) == ""
    warned = replace(found(), warning=too_few_days("crossed", 2))
    assert answer(warned)[-1].startswith("Two days cannot tell how much days differ")
    assert any("--design nested" in sentence for sentence in reading(warned)[-1:])


def test_people_who_make_no_difference_are_told_so():
    rates = 61 + np.random.default_rng(1).normal(size=(40, 4))
    assert variance_parts(rates)["staffing"].truncated
    assert answer(found(rates))[0].startswith("There is no sign that it matters who is hired")


def test_names_are_no_markup_anywhere():
    page = study_html(labour_page(found(curves=(curve("more like <u>ana</u>", "workers", 9.0),)), "<b>Line</b>"))
    assert not any(mark in page for mark in ("<i>", "<u>", "<b>"))


@pytest.mark.parametrize("target", ["480 a day", "1 a day", "9000 a day", "throughput_per_h <= 60"])
def test_pictures_stand_within_their_width(target):
    made = found(curves=(curve("more like ana", "workers", 5.0, -9.5),), target=target)
    for picture in (parts_svg(made.parts), budget_svg(made.budget[0]), bought_svg(made.bought), day_svg(made.day)):
        assert picture.startswith("<svg") and "nan" not in picture
        places = [float(piece.split('"')[0]) for piece in picture.split(' x="')[1:]]
        assert all(0 <= place <= 460 for place in places)


def test_days_that_are_all_alike_have_no_histogram():
    assert day_svg(Made(values=np.full((3, 2), 4.0), asked=Made(target=None, a_day=True), quantiles=())) == ""


def test_a_short_day_is_said_beside_its_target():
    one = found()
    short = replace(one, day=replace(one.day, asked=replace(one.day.asked, hours=2.0)))
    assert any(said.startswith("You reach 480 a day (a day is 2 h here) with") for said in answer(short))


def test_a_figure_in_per_cent_does_not_say_that_it_goes_from_0_to_1():
    key = ("fatigue_mean", "", "", "share")
    assert figure_name(key, "%") == "Fatigue at work" and figure_name(key, "").endswith("from 0 (fresh) to 1")


def test_the_page_shows_each_table_once_and_the_target_does_not_strike_out_a_name():
    html = study_html(labour_page(found(curves=(curve("more like ana", "workers", 5.0, 9.5),)), "t"))
    assert html.count("luck of the day, for all alike</td>") == 1 and html.count("more like ana</td>") == 1
    assert " 22V" in day_svg(found().day) and " 8V" not in day_svg(found().day)


BUDGET_KEY = ("throughput_per_h", "", "", "1/h")
TEXT = """
opsim: 1
name: switches
run: {horizon: 30 min, replications: 3, seed: 5, staffing: redrawn}
layout: {places: {a: [0 m, 0 m]}}
tasks: {label: {dist: lognormal, mean: 12 s, cv: 0.3, between_share: 0.6}}
stations: {one: {at: a, tasks: [label], buffer: 3}}
products: {box: {route: [one]}}
release: {kind: saturated}
workers: {ana: {skills: {one: 1.0}}}
overrides:
  w: {run.variability: within_only}
  b: {run.variability: between_only}
  n: {run.variability: none}
  m: {workers.ana.skills: {one: 1.1}}
scenarios: {base: [], alike: [w], steady: [b], neither: [n], quicker: [m]}
outputs: [throughput_per_h, time_in_system_s]
"""


def test_parts_and_what_they_do_to_each_other_add_up_to_the_whole():
    rng = np.random.default_rng(3)
    values = {switch: rng.normal(50, 5, 12) for switch in ("full", "within_only", "between_only", "none")}
    one = budget_of(BUDGET_KEY, values)
    assert one.whole.mean == pytest.approx(one.all_off.mean - one.full.mean)
    assert sum(part.mean for part in one.parts.values()) + one.interaction.mean == pytest.approx(one.whole.mean)
    assert one.parts["between workers"].mean == pytest.approx((values["within_only"] - values["full"]).mean())


@pytest.fixture(scope="module")
def runs(tmp_path_factory):
    folder = tmp_path_factory.mktemp("switches")
    read = scenarios_in(TEXT.encode(), HERE / "switches.yaml")
    results = {name: run_scenario(one, folder=folder / name, processes=1) for name, one in read.items()}
    return {name: Material(opened(results[name], read[name]), results) for name in read}


def test_each_switch_is_told_with_its_interval_and_a_waterfall_is_drawn(runs):
    section = budget.variance_budget_section(runs["base"])
    said = texts(section)
    assert "People alike: " in " ".join(section.blocks[0].items) and "other people and other days" in said
    assert "both off is the variant neither" in said and "quicker" not in said
    panels = next(block for block in section.blocks if isinstance(block, Panels))
    assert panels.blocks and "what they do to each other" in panels.blocks[0].text
    table = next(block for block in section.blocks if isinstance(block, Grid))
    assert table.columns == ("Figure", "as it is", "people alike", "each steady", "both off")


def test_all_who_differ_by_a_switch_say_the_same_and_others_nothing(runs):
    assert texts(budget.variance_budget_section(runs["neither"])) == texts(budget.variance_budget_section(runs["base"]))
    assert budget.variance_budget_section(runs["quicker"]) is None


def test_one_variant_has_no_budget(runs):
    base = runs["base"]
    assert budget.variance_budget_section(Material(base.run, {"base": base.result})) is None

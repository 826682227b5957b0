"""Exposure on the floor: circles as large as the minutes, and what is not known said so."""

import math
import re
from math import pi
from types import SimpleNamespace

import pytest
from plans import loaded, plan

from opsim.report.page import Legend, Section, Svg, Words
from opsim.report.plot.floor_plan import floor_map
from opsim.report.sections import exposure_map
from opsim.report.sections.exposure import MOST_WORKERS as MOST
from opsim.report.sections.exposure import exposure_blocks
from opsim.report.sections.exposure_map import circles_of, said_of
from opsim.report.sections.exposure_summary import (
    FIVE,
    PERHAPS,
    SEVEN,
    Bar,
    bar_of_all,
    bars_by,
    bars_of_regions,
    bars_of_workers,
    exposure_sentences,
    level_bars,
    limit_sentences,
)
from opsim.report.sections.exposure_summary import MOST as MOST_of_limit_sentences
from opsim.report.sections.exposure_summary import bar_legend as legend
from tests.made.result import SCRIPT
from tests.opsim.report.made_exposure import ROWS, by, levels, row
from tests.opsim.report.made_material import hostile, of_log
from tests.opsim.study.layout.made_floor import FLOOR


def charts(rows):
    return Section("exposure", "", exposure_blocks(rows, 0.95)).charts


def test_the_section_has_a_figure_of_everything_that_has_more_than_one_bar():
    assert list(charts(ROWS)) == ["exposure_workers", "exposure_by_hour", "exposure_by_task", "exposure_by_region"]
    (legend,) = (block for block in exposure_blocks(ROWS, 0.95) if isinstance(block, Legend))
    assert legend.entries == [SEVEN, FIVE, PERHAPS]


def test_without_scores_there_is_no_section():
    assert exposure_blocks([], 0.95) == []


def test_of_many_workers_those_with_most_are_shown_in_their_order():
    rows = [row for n in range(MOST + 5) for row in levels(f"w{n}", 0, n, n)]
    assert charts([*levels("", 1, 2, 3), *rows])["exposure_workers"]["layout"]["yaxis"]["ticktext"] == [
        f"w{n}" for n in range(5, MOST + 5)
    ]


def test_no_name_becomes_markup_in_a_figure():
    rows = [*levels("", 1, 2, 3), *levels(SCRIPT, 1, 2, 3), *by("exposure_by_task", SCRIPT, 1, 2, 3)]
    assert "<script" not in str(charts(rows))


def test_the_parts_of_a_bar_end_at_the_most_there_may_be():
    figure = level_bars(bars_of_workers(ROWS))
    parts = [trace for trace in figure["data"] if trace["type"] == "bar"]
    assert [trace["name"] for trace in parts] == [SEVEN[1], FIVE[1], PERHAPS[1]]
    assert [sum(values) for values in zip(*(trace["x"] for trace in parts))] == [30.0, 18.0]
    (line,) = [trace for trace in figure["data"] if trace["type"] == "scatter"]
    assert line["x"] == [25.0, 15.0] and line["error_x"]["array"] == [0.5, 0.5]


def test_bars_of_hours_stand_upright_and_one_replication_has_no_line():
    figure = level_bars([Bar("06:00", 1.0, 2.0, 2.0)], upright=True)
    assert [trace["type"] for trace in figure["data"]] == ["bar", "bar"] and figure["data"][0]["y"] == [1.0]
    assert legend([Bar("06:00", 0.0, 2.0, 2.0)]) == [FIVE]


def test_nothing_at_all_is_still_a_figure():
    assert level_bars([Bar("ana", 0.0, 0.0, 0.0)])["data"]


KPI = "exposure_by_station"
TEXT = FLOOR.replace("libraries:", "").replace(
    "tasks: {t: {dist: lognormal, mean: 20 s, cv: 0.2}}",
    "libraries: {bench: libraries/bench_work.npz}\n"
    "tasks: {t: {dist: lognormal, mean: 20 s, cv: 0.2}, lift: {emulator: bench/lift}}",
).replace("saw:   {at: p1, tasks: [t]", "saw:   {at: p1, tasks: [lift]").replace(
    "drill: {at: p5, tasks: [t]", "drill: {at: p5, tasks: [lift, t]"
)  # fmt: skip
EXPOSURE_MAP_ROWS = [*by(KPI, "saw", 2.0, 8.0, 8.0), *by(KPI, "drill", 0.0, 2.0, 4.0), *by(KPI, "pack", 0.0, 0.0, 0.0)]


def made(rows=EXPOSURE_MAP_ROWS, text=TEXT):
    return of_log(SimpleNamespace(), plan(text), loaded(text), rows)


def circles(rows=EXPOSURE_MAP_ROWS):
    of = made(rows)
    layout = of.loaded.scenario.layout
    bars = {bar.subject: bar for bar in bars_by(rows, KPI)}
    return {one.name: one for one in circles_of(bars, of.plan, layout, floor_map(of.plan, layout))}


def test_areas_are_as_the_minutes():
    found = circles()
    assert found["saw"].radius ** 2 / found["drill"].radius ** 2 == pytest.approx(8.0 / 4.0)
    drawn = next(block for block in exposure_map.exposure_map_section(made()).blocks if isinstance(block, Svg)).text
    of_saw = re.search(r"<g><title>saw:.*?</g>", drawn).group()
    areas = [pi * float(r) ** 2 for r in re.findall(r'r="([\d.]+)"', of_saw)]
    assert areas[1] / areas[0] == pytest.approx(2.0 / 8.0, rel=0.03)


def test_what_is_not_known_is_said_and_is_no_zero():
    found = circles()
    assert found["pack"].bar is None and found["drill"].open_tasks == ("t",)
    assert said_of(found["pack"]) == "pack: nothing known of the postures"
    section = exposure_map.exposure_map_section(made())
    words = [block.text for block in section.blocks if isinstance(block, Words)]
    assert words == [
        "Of all minutes at RULA 5 or more are 80 % at saw and 20 % at drill.",
        "Nothing is known of the postures at pack: what people go through there is in no figure.",
    ]
    svg = next(block for block in section.blocks if isinstance(block, Svg))
    assert ">?</text>" in svg.text and ">not known</text>" in svg.text and ">2.0 ± 0.5 +?</text>" in svg.text
    assert [entry[2] for entry in svg.legend][-1] == "nothing known of the postures there"


def test_stations_at_one_place_stand_beside_each_other():
    text = TEXT.replace("at: p5", "at: p1")
    of = made(text=text)
    layout = of.loaded.scenario.layout
    found = circles_of(
        {b.subject: b for b in bars_by(EXPOSURE_MAP_ROWS, KPI)}, of.plan, layout, floor_map(of.plan, layout)
    )
    saw, drill = (next(one for one in found if one.name == name) for name in ("saw", "drill"))
    assert abs(saw.at[0] - drill.at[0]) >= saw.radius + drill.radius and saw.at[1] == drill.at[1]


def test_where_nobody_is_exposed_there_is_no_section():
    assert exposure_map.exposure_map_section(made([*by(KPI, "saw", 0.0, 0.0, 0.0)])) is None
    assert exposure_map.exposure_map_section(made([{"kpi": "walked_m", "subject": "", "part": ""}])) is None


def test_hostile_names_do_no_harm():
    of = of_log(SimpleNamespace(), hostile(plan(TEXT), SCRIPT), loaded(TEXT), by(KPI, f"{SCRIPT}saw", 2.0, 8.0, 8.0))
    svg = next(block for block in exposure_map.exposure_map_section(of).blocks if isinstance(block, Svg))
    assert "<script" not in svg.text and "&lt;script" in svg.text


def test_a_worker_has_a_bar_with_what_is_sure_and_what_may_be():
    ana, ben = bars_of_workers(ROWS)
    assert ana == Bar("ana", 6.0, 25.0, 30.0, 24.5, 25.5) and ben.subject == "ben" and ana.is_open
    assert bar_of_all(ROWS).five == 20.0


def test_what_is_at_no_station_is_shown_only_where_it_is_something():
    assert [bar.subject for bar in bars_by(ROWS, "exposure_by_station")] == ["shelf"]
    nowhere = by("exposure_by_station", "none", 0.0, 0.0, 1.0)
    assert [bar.subject for bar in bars_by(nowhere, "exposure_by_station")] == ["none"]


def test_regions_come_by_length_and_without_those_that_bring_in_nothing():
    assert [(bar.subject, bar.five, bar.is_open) for bar in bars_of_regions(ROWS)] == [
        ("trunk", 12.0, False),
        ("load", 8.0, False),
    ]


def test_what_was_never_known_has_no_bar_and_one_replication_no_interval():
    unknown = [{**row, "mean": None} for row in ROWS]
    assert bars_of_workers(unknown) == [] and bar_of_all(unknown) is None and bar_of_all([]) is None
    once = [{**row, "low": None, "high": None, "half_width": None} for row in levels("ana", 1.0, 2.0, 3.0)]
    (bar,) = bars_of_workers(once)
    assert math.isnan(bar.low) and bar.five == 2.0


def test_who_where_when_and_which_region_are_said_with_their_intervals():
    said = " ".join(exposure_sentences(ROWS))
    assert (
        "ana is exposed most: 25.0 (24.5 to 25.5) minutes of each hour at RULA 5 or more, 6.0 of them at RULA 7" in said
    )
    assert "ben has least, 15.0 (14.5 to 15.5)." in said
    assert "these tasks take: pick 80 % and pack 20 %." in said
    assert "worst hour is that from 06:00" in said and "best that from 07:00" in said
    assert "What brings people to RULA 5 or more: the trunk (60 %) and the load (40 %)." in said
    assert "What brings them to RULA 7: the trunk (75 %) and the load (25 %)." in said
    assert "at least 20.00 and at most 24.00 minutes" in said and "of an hour of who is there, breaks included" in said


def test_how_much_of_the_work_is_seen_is_said_with_the_bounds():
    known = row("posture_measured_share", "", "", 0.56, 0.01) | {"unit": "share"}
    said = exposure_sentences([*ROWS, known])[-1]
    assert "24.00 minutes of an hour, of the 56 % of the work whose posture is known" in said
    assert "is known" not in exposure_sentences([*ROWS, known | {"mean": 1.0}])[-1]


def test_how_evenly_three_workers_share_it_is_said():
    gini = row("exposure_gini", "", "rula_from_5", 0.34, 0.05) | {"unit": "1"}
    rows = [*ROWS, *levels("cy", 1.0, 16.0, 17.0), gini]
    assert "all alike, near 1: one has it all): 0.34 (0.29 to 0.39)." in " ".join(exposure_sentences(rows))
    assert "Gini" not in " ".join(exposure_sentences([*ROWS, gini]))


def test_what_intervals_do_not_tell_apart_is_not_said_to_differ():
    rows = [*levels("", 0, 10, 10, 3), *levels("ana", 0, 11, 11, 3), *levels("ben", 0, 9, 9, 3)]
    rows += [*by("exposure_by_hour", "06:00", 0, 11, 11, 3), *by("exposure_by_hour", "07:00", 0, 9, 9, 3)]
    rows += [*by("exposure_by_station", "a", 0, 6, 6, 3), *by("exposure_by_station", "b", 0, 4, 4, 3)]
    said = " ".join(exposure_sentences(rows))
    assert "not told apart" in said and "no hour is told apart" in said and "station" not in said


def test_nothing_is_said_where_nobody_asked_and_that_nobody_was_seen_where_nobody_was():
    assert exposure_sentences([]) == []
    assert exposure_sentences([*levels("", 0, 0, 0), *levels("ana", 0, 0, 0)]) == ["Nobody was seen at RULA 5 or more."]
    only_maybe = exposure_sentences([*levels("", 0, 0, 5), *levels("ana", 0, 0, 5)])
    assert only_maybe[0] == "Nobody is surely at RULA 5 or more." and "at most" in only_maybe[-1]


def limit_sentences_row(kpi, subject, part, mean):
    return {"kpi": kpi, "subject": subject, "part": part, "mean": mean}


def test_a_load_beyond_the_limit_is_said_and_one_within_is_not():
    rows = [
        limit_sentences_row("lifting_index", "pick", "", 1.6),
        limit_sentences_row("lifting_index", "pick", "at_most", 2.1),
    ]
    rows += [
        limit_sentences_row("lifting_index", "pack", "", 0.4),
        limit_sentences_row("lifting_index", "pack", "at_most", 0.5),
    ]
    (said,) = limit_sentences(rows)
    assert "pick" in said and "1.6 to 2.1" in said


def test_what_was_not_asked_for_or_never_known_says_nothing():
    assert limit_sentences([]) == [] and limit_sentences([limit_sentences_row("lifting_index", "pick", "", None)]) == []


def test_many_limits_are_cut_and_counted():
    rows = [
        limit_sentences_row("composite_lifting_index", f"w{n}", "", 2.0) for n in range(MOST_of_limit_sentences + 3)
    ]
    said = limit_sentences(rows)
    assert len(said) == MOST_of_limit_sentences + 1 and said[-1].startswith("And 3 more")

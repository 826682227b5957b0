"""Exposure on the floor: circles as large as the minutes, and what is not known said so."""

import re
from math import pi
from types import SimpleNamespace

import pytest
from plans import loaded, plan

from opsim.report.page import Svg, Words
from opsim.report.plot.floor_plan import floor_map
from opsim.report.sections import exposure_map
from opsim.report.sections.exposure_map import circles_of, said_of
from opsim.report.sections.exposure_summary import bars_by
from tests.made_result import SCRIPT
from tests.opsim.report.made_exposure import by
from tests.opsim.report.made_material import hostile, of_log
from tests.opsim.study.layout.made_floor import FLOOR

KPI = "exposure_by_station"
TEXT = FLOOR.replace("libraries:", "").replace(
    "tasks: {t: {dist: lognormal, mean: 20 s, cv: 0.2}}",
    "libraries: {bench: libraries/bench_work.npz}\n"
    "tasks: {t: {dist: lognormal, mean: 20 s, cv: 0.2}, lift: {emulator: bench/lift}}",
).replace("saw:   {at: p1, tasks: [t]", "saw:   {at: p1, tasks: [lift]").replace(
    "drill: {at: p5, tasks: [t]", "drill: {at: p5, tasks: [lift, t]"
)  # fmt: skip
ROWS = [*by(KPI, "saw", 2.0, 8.0, 8.0), *by(KPI, "drill", 0.0, 2.0, 4.0), *by(KPI, "pack", 0.0, 0.0, 0.0)]


def made(rows=ROWS, text=TEXT):
    return of_log(SimpleNamespace(), plan(text), loaded(text), rows)


def circles(rows=ROWS):
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
    found = circles_of({b.subject: b for b in bars_by(ROWS, KPI)}, of.plan, layout, floor_map(of.plan, layout))
    saw, drill = (next(one for one in found if one.name == name) for name in ("saw", "drill"))
    assert abs(saw.at[0] - drill.at[0]) >= saw.radius + drill.radius and saw.at[1] == drill.at[1]


def test_where_nobody_is_exposed_there_is_no_section():
    assert exposure_map.exposure_map_section(made([*by(KPI, "saw", 0.0, 0.0, 0.0)])) is None
    assert exposure_map.exposure_map_section(made([{"kpi": "walked_m", "subject": "", "part": ""}])) is None


def test_hostile_names_do_no_harm():
    of = of_log(SimpleNamespace(), hostile(plan(TEXT), SCRIPT), loaded(TEXT), by(KPI, f"{SCRIPT}saw", 2.0, 8.0, 8.0))
    svg = next(block for block in exposure_map.exposure_map_section(of).blocks if isinstance(block, Svg))
    assert "<script" not in svg.text and "&lt;script" in svg.text

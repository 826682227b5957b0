"""Why times differ: what lies between people and what within each."""

from types import SimpleNamespace

import numpy as np
import pytest
from plans import loaded, plan

from opsim.report.page import Svg
from opsim.report.sections import variability as time_spread
from opsim.report.sections.variability import Spread, spreads
from opsim.streams import stream
from tests.made_result import SCRIPT
from tests.opsim.report.made_material import hostile, of_log
from tests.opsim.study.layout.made_floor import FLOOR

TEXT = FLOOR.replace(
    "tasks: {t: {dist: lognormal, mean: 20 s, cv: 0.2}}",
    "tasks: {t: {dist: lognormal, mean: 20 s, cv: 0.2}, u: {dist: gamma, mean: 9 s, cv: 0.4, between_share: 0.6}, "
    "v: {fixed: 3 s}}",
).replace("pack:  {at: p3, tasks: [t]", "pack:  {at: p3, tasks: [u, v]")


def made(text=TEXT):
    return of_log(SimpleNamespace(), plan(text), loaded(text), [{"kpi": ""}])


def test_both_parts_together_are_the_whole():
    one = Spread("u", 0.4, 0.6)
    assert (1 + one.between**2) * (1 + one.within**2) == pytest.approx(1 + 0.4**2)


def test_the_parts_are_what_is_drawn():
    p = plan(TEXT)
    model = next(task.model for task in p.tasks if task.name == "u")
    rng = stream(3, 0, "test")
    means = [model.mean_duration_s(model.draw_worker(rng)) for _ in range(20_000)]
    one = next(one for one in spreads(p, "full") if one.task == "u")
    assert np.std(means) / np.mean(means) == pytest.approx(one.between, rel=0.03)


@pytest.mark.parametrize(
    "switch, found",
    [
        ("full", {"u": (0.4, 0.6), "t": (0.2, 0.0)}),
        ("within_only", {"u": (0.2473, 0.0), "t": (0.2, 0.0)}),
        ("between_only", {"u": (0.3052, 1.0)}),
        ("none", {}),
    ],
)
def test_what_the_run_switches_off_is_left_out(switch, found):
    told = {one.task: (one.cv, one.share) for one in spreads(plan(TEXT), switch)}
    assert told == {task: pytest.approx(of, abs=2e-4) for task, of in found.items()}


def test_who_differs_most_is_said_and_where_nobody_differs_nothing_is():
    section = time_spread.time_spread_section(made())
    assert section.blocks[0].text.startswith(
        "The times of u differ most between people: their means lie about 31 % (standard deviation) around that of all"
    )
    assert time_spread.time_spread_section(made(FLOOR)) is None


def test_hostile_names_do_no_harm():
    section = time_spread.time_spread_section(
        of_log(SimpleNamespace(), hostile(plan(TEXT), SCRIPT), loaded(TEXT), [{"kpi": ""}])
    )
    svg = next(block for block in section.blocks if isinstance(block, Svg))
    assert "<script" not in svg.text and "&lt;script" in svg.text

import plans
import pytest
from human_plans import LINE, planned

from opsim.engine.floor import run_plan
from opsim.kpi import figures
from opsim.kpi.catalogue import KPIS
from opsim.report.numbers import NAMES

ONE = """
opsim: 1
name: one
run: {horizon: 1200 s, warm_up: 300 s, seed: 1}
layout: {places: {a: [0 m, 0 m]}}
tasks: {make: {fixed: 150 s}}
stations: {s: {at: a, tasks: [make], buffer: 1}}
products: {part: {route: [s]}}
release: {kind: saturated}
workers: {w: {skills: {s: 1.0}}}
human:
  fatigue: {model: lffrm, tires_half_in: 10 min, recovers_half_in: 5 min, slows: 0}
  rest: {above: 0.4, until: 0.2}
"""
MINE = ("fatigue_mean", "fatigue_most", "rest_taken_min_per_h")


def found(log, plan):
    return {(f.kpi, f.subject, f.part): f.value for f in figures(log, plan)}


def test_figures_of_a_hand_worked_quarter_of_an_hour():
    # work to 450 s, rest of 305.800 s to 755.800 s (test_human_rest.py), work to 1055.800 s, rest until 1200 s; the
    # window begins at 300 s. Levels: 0.292893 at 300 s, 0.405396 at 450; 0.2, 0.327282, 0.434314 after two more
    # mean: 0.5 (0.292893 + 0.405396) 150 + 0.5 (0.2 + 0.327282) 150 + 0.5 (0.327282 + 0.434314) 150, over 450: 0.331195
    # rest: 305.800 + 144.200 = 450 s of 900 s, 30 minutes an hour
    values = found(*plans.ran(ONE))
    for name in ("", "w"):
        assert values["fatigue_mean", name, ""] == pytest.approx(0.331195, abs=2e-6)
        assert values["fatigue_most", name, ""] == pytest.approx(0.434315, abs=2e-6)
        assert values["rest_taken_min_per_h", name, ""] == pytest.approx(30.0, abs=1e-3)
    assert values["worker_states", "w", "rest"] == pytest.approx(0.5, abs=1e-5)
    assert sum(value for (kpi, _, _), value in values.items() if kpi == "worker_states") == pytest.approx(1.0)


def test_muscles_have_a_figure_for_each_joint():
    text = ONE.replace("make: {fixed: 150 s}", "make: {emulator: work/stoop, load: 10 kg}").replace(
        "layout:", "libraries: {work: libraries/bench_work.npz}\nlayout:"
    )
    values = found(*plans.ran(text[: text.index("human:")] + "human: {fatigue: {model: 3cc_r}}\n"))
    joints = {
        part: value for (kpi, who, part), value in values.items() if kpi == "fatigue_most" and who == "w" and part
    }
    assert max(joints.values()) == values["fatigue_most", "w", ""] > min(joints.values())
    assert not any(kpi == "rest_taken_min_per_h" for kpi, _, _ in values)


def test_figures_are_there_only_where_people_tire():
    plan = planned(LINE)
    assert not set(MINE) & {kpi for kpi, _, _ in found(run_plan(plan), plan)}
    assert set(MINE) <= set(KPIS) and set(MINE) <= set(NAMES)

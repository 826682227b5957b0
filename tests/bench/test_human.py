"""What fatigue costs a run: a line of three, a plant with shifts, an assembly line. It slows nobody, so that as much
happens with it as without."""

from dataclasses import replace

import pytest
from bench.cpu import best_s
from human_plans import LINE, planned, shipped

from opsim.engine.floor.run import run_plan
from opsim.log import COLUMNS
from opsim.subjects.human.fatigue import Lffrm
from opsim.subjects.human.muscle_fatigue import Burdens, ThreeCompartment
from opsim.subjects.human.plan import NO_EFFECTS, HumanPlan

MOST_MORE = 0.30
MOST_BURDEN_MS = 100.0
MODELS = {"lffrm": Lffrm(slows=0.0), "3cc_r": ThreeCompartment(slows=0.0)}
FLOORS = {
    "line of 3, times": lambda: replace(planned(LINE), horizon_s=200 * 3600.0),
    "two_shift_plant": lambda: shipped("two_shift_plant", 18),
    "pump_assembly": lambda: shipped("pump_assembly", 8),
}


@pytest.mark.parametrize("floor", FLOORS)
def test_fatigue_adds_at_most_thirty_in_a_hundred_to_a_run(floor):
    plain = replace(FLOORS[floor](), human=NO_EFFECTS)
    plans = [plain, *(replace(plain, human=HumanPlan(fatigue=model)) for model in MODELS.values())]
    same = run_plan(plans[0])
    for plan in plans[1:]:
        log = run_plan(plan)
        assert all((log[name] == same[name]).all() for name in COLUMNS if not name.startswith("p"))
    alone_s, *with_s = best_s(*(lambda plan=plan: run_plan(plan) for plan in plans), rounds=7)
    more = {name: one_s / alone_s - 1 for name, one_s in zip(MODELS, with_s)}
    said = ", ".join(f"{name} {share:+.0%}" for name, share in more.items())
    print(f"\n{floor}: {alone_s:.3f} s without; {said} (target +{MOST_MORE:.0%})")
    assert max(more.values()) < MOST_MORE


def test_the_burdens_of_an_assembly_line_are_made_once_and_soon():
    plan = shipped("pump_assembly", 8)
    n = len(plan.workers) * len(plan.tasks)

    def all_of_them(workforce):
        burdens = Burdens(plan, workforce)
        return [burdens.course(worker, task) for worker in range(len(plan.workers)) for task in range(len(plan.tasks))]

    fresh = iter(range(1, 100))
    first_s, again_s = best_s(lambda: all_of_them(next(fresh)), lambda: all_of_them(1), rounds=3)
    print(f"\n{n} burdens: {1000 * first_s / n:.1f} ms each, {1e6 * again_s / n:.1f} us each when asked again")
    assert 1000 * first_s / n < MOST_BURDEN_MS and again_s < 0.05 * first_s

"""Lifting indices as figures."""

import math
from dataclasses import replace

import numpy as np
import pytest

from opsim.kpi import figures
from opsim.kpi.catalogue import LIFTED
from opsim.kpi.strain import lifting_sentences as sentences
from opsim.plan.tasks import Handling, Moment
from tests.opsim.ergonomics.made_work import BEND, made_plan
from tests.opsim.kpi.made_logs import found, made, work

UP_AGAIN = {"start": Moment(share=0.5), "end": Moment(share=1.0)}


def plan_with(**handling):
    """Who bends takes a load at the lowest and lets go of it upright."""
    plan = made_plan()
    tasks = list(plan.tasks)
    tasks[BEND] = replace(tasks[BEND], handling=Handling(**{**UP_AGAIN, **handling}))
    return replace(plan, tasks=tuple(tasks), workers=tuple(replace(one, rating=(1.0,)) for one in plan.workers))


def figures_of(plan, n=20, every_s=60.0, asked=LIFTED):
    log = made([work(every_s * k, every_s * k + 9, 0, worker=0, task=BEND, k=k) for k in range(n)], plan)
    return {(f.kpi, f.subject, f.part): f.value for f in figures(log, plan, asked=asked)}


def test_a_run_of_lifts_has_an_index_for_its_task_and_its_worker():
    """One kind of lift alone: the composite of its worker is the index of its task."""
    value = figures_of(plan_with(load_kg=10.0, grip="fair"))
    low, high = value["lifting_index", "bend", ""], value["lifting_index", "bend", "at_most"]
    assert 0.4 < low <= high <= value["lifting_index", "bend", "most"] + 1e-12
    assert value["lifts_per_h", "bend", ""] == pytest.approx(20.0)
    assert value["composite_lifting_index", "ana", ""] == pytest.approx(low, rel=1e-6)
    assert value["composite_lifting_index", "ben", ""] == 0.0
    assert value["composite_lifting_index", "", "worst"] == value["composite_lifting_index", "ana", ""]


@pytest.mark.parametrize("side", ["", "at_most"])
def test_twice_the_load_is_twice_the_index(side):
    once, twice = (figures_of(plan_with(load_kg=load))["lifting_index", "bend", side] for load in (6.0, 12.0))
    assert twice == pytest.approx(2 * once)


def test_a_grip_that_nobody_told_widens_the_index():
    said, unsaid = (figures_of(plan_with(load_kg=10.0, grip=grip)) for grip in ("good", None))
    key = "lifting_index", "bend"
    assert unsaid[*key, ""] == said[*key, ""] and unsaid[*key, "at_most"] > said[*key, "at_most"]


def test_a_load_that_nobody_told_has_no_index():
    value = figures_of(plan_with())
    assert not [key for key in value if key[0] == "lifting_index"]
    assert value["composite_lifting_index", "ana", ""] == 0.0


def test_a_task_that_nobody_does_has_none_either():
    assert math.isnan(figures_of(plan_with(load_kg=10.0), n=0)["lifting_index", "bend", ""])


def test_nobody_pays_for_what_nobody_asked():
    plan = plan_with(load_kg=10.0)
    log = made([work(0, 9, 0, worker=0, task=BEND, k=0)], plan)
    assert not {kpi for kpi, _, _ in found(log, plan)} & set(LIFTED)


def test_a_sentence_says_where_the_edge_of_the_equation_stands_for_what_is_beyond():
    values = {("lifting_index", "pick", ""): 1.5, ("lifting_index", "pick", "at_most"): 1.5}
    (said,) = sentences({**values, ("lifts_out_of_range_share", "pick", ""): 0.25})
    assert said.endswith("(NIOSH); 25% of lifts are beyond the equation's range, whose edge stands for them: no bound.")
    (said,) = sentences({**values, ("lifts_out_of_range_share", "pick", ""): 0.0})
    assert said.endswith("(NIOSH).")


def test_what_is_lifted_sitting_has_no_index():
    value = figures_of(plan_with(load_kg=10.0, grip="good", sitting=True))
    assert math.isnan(value["lifting_index", "bend", ""]) and math.isnan(value["lifting_index", "bend", "at_most"])
    assert math.isnan(value["composite_lifting_index", "ana", ""])
    assert value["composite_lifting_index", "", "worst"] == 0.0
    assert value["lifts_out_of_range_share", "bend", ""] == 1.0


def test_sentences_say_who_and_how_far():
    index, composite = "lifting_index", "composite_lifting_index"
    values = {
        (index, "pick", ""): 1.24, (index, "pick", "at_most"): 1.5,
        (index, "place", ""): 0.8, (index, "place", "at_most"): 1.1,
        (index, "look", ""): 0.2, (index, "look", "at_most"): 0.2, (index, "none", ""): np.nan,
        (composite, "ana", ""): 2.0, (composite, "ana", "at_most"): 2.0, (composite, "", "worst"): 2.0,
    }  # fmt: skip
    assert list(sentences(values)) == [
        "In pick the load is 1.2 to 1.5 times the recommended limit (NIOSH).",
        "In place the load is up to 1.1 times the recommended limit (NIOSH), depending on what nobody said.",
        "All that ana lifts together comes to 2.0 times the recommended limit (NIOSH).",
    ]

"""Energy and rest allowances as figures.

Holds, movements and repetition as figures.

Lifting indices as figures.
"""

import math
from dataclasses import replace

import numpy as np
import pytest

from opsim.kpi import figures
from opsim.kpi.catalogue import ENERGY, HELD, LIFTED, REST
from opsim.log import BREAK, OFF, WALK
from opsim.subjects.exposure.plan import Handling
from opsim.subjects.exposure.strain_figures import energy_sentences as sentences
from opsim.subjects.exposure.strain_figures import hold_sentences as sentences_of_holds
from opsim.subjects.exposure.strain_figures import lifting_sentences as sentences_of_lifting
from opsim.subjects.people.plan import Body
from opsim.subjects.tools.plan import Moment
from tests.opsim.ergonomics.made_work import BEND, Bending, Bends, made_plan
from tests.opsim.kpi.made_logs import found, made, row, work


def people(plan, **body):
    return replace(plan, workers=tuple(replace(one, body=Body(**body)) for one in plan.workers))


def values(rows, plan, asked):
    from opsim.kpi import figures

    return {(f.kpi, f.subject, f.part): f.value for f in figures(made(rows, plan), plan, asked=asked)}


def test_standing_and_a_break_by_hand():
    """ben, 70 kg: 50 min standing at 1.68 and 10 in a break at 1.61 kcal/min; ana is away."""
    plan = people(made_plan(), mass_kg=70.0)
    found = values([row(BREAK, 0, 600, worker=1), row(OFF, 0, 3600, worker=0)], plan, ENERGY)
    assert found["energy_kcal_per_min", "ben", ""] == pytest.approx((50 * 1.68 + 10 * 1.61) / 60)
    assert np.isnan(found["energy_kcal_per_min", "ana", ""])
    assert found["energy_kcal_per_min", "", ""] == found["energy_kcal_per_min", "", "worst"]


def test_a_way_by_hand():
    """6 of 60 min of walking at 1.2 m/s: 0.01 x (51 + 2.54 x 70 x 1.44) net."""
    plan = people(made_plan(), mass_kg=70.0)
    plan = replace(plan, workers=tuple(replace(one, walk_m_per_s=1.2) for one in plan.workers))
    found = values([row(WALK, 0, 360, worker=0, places=(0, 0))], plan, ENERGY)
    net = 0.1 * 0.01 * (51 + 2.54 * 70 * 1.44)
    assert found["energy_kcal_per_min", "ana", ""] == pytest.approx(1.68 + net)


def test_lifting_costs_and_more_of_it_costs_more():
    ways = ((0.0, 5), (10.0, 5), (10.0, 10))
    found = [
        figures_of(people(plan_with(load_kg=load), mass_kg=70.0, sex="m"), n, asked=ENERGY)[ENERGY[0], "ana", ""]
        for load, n in ways
    ]
    assert found == sorted(found) and len(set(found)) == len(found)


def test_light_work_asks_for_no_rest():
    found = figures_of(plan_with(load_kg=1.0), asked=REST)
    parts = ("murrell", "murrell_at_most", "price", "price_at_most")
    assert all(found[REST[0], "ana", part] == 0.0 for part in parts)


def test_a_held_stoop_asks_for_rest_by_rohmert():
    """A stoop of 60 degrees held all of nine seconds, again and again: one hold as long as the work."""
    plan = made_plan(Bending(kind=Stooping))
    still = values([work(9 * k, 9 * k + 9, 0, worker=0, task=BEND, k=k) for k in range(20)], plan, REST)
    moving = values([work(9 * k, 9 * k + 9, 0, worker=0, task=BEND, k=k) for k in range(20)], made_plan(), REST)
    assert still[REST[0], "ana", "rohmert"] > 0.05 > moving[REST[0], "ana", "rohmert"]
    assert still[REST[0], "ben", "rohmert"] == 0.0


def test_the_base_of_rohmerts_share_is_the_time_at_work_with_its_rest():
    """600 s held ask for a rest of r s: r / (r + 3600) of an hour at work, r / (r + 1800) with half of it a break.

    From shares a and b: r = 3600 a / (1 - a) = 1800 b / (1 - b).
    """
    plan = made_plan(Bending(kind=Stooping))
    rows = [work(0, 600, 0, worker=0, task=BEND, k=0)]
    a = values(rows, plan, REST)[REST[0], "ana", "rohmert"]
    b = values([*rows, row(BREAK, 1800, 3600, worker=0)], plan, REST)[REST[0], "ana", "rohmert"]
    assert 3600 * a / (1 - a) == pytest.approx(1800 * b / (1 - b)) and b > a > 0.05


class Stooping(Bending().kind):
    """Bent by 60 degrees from beginning to end."""

    course = staticmethod(lambda share: np.full(np.shape(share), 60.0))


def test_sentences_say_who_needs_how_much():
    share = REST[0]
    found = {(share, "ana", "murrell"): 0.12, (share, "ana", "murrell_at_most"): 0.3, (share, "ben", "rohmert"): 0.004}
    assert list(sentences(found)) == ["ana: 12% of the time should be rest for the energy of the work (Murrell)."]
    assert list(sentences(found, {"ana": 0.05})) == [
        "ana: 12% of the time should be rest for the energy of the work (Murrell); his breaks are 5%."
    ]


def of(rows, plan):
    return values(rows, plan, HELD)


def in_turn(n, lasting=9.0, worker=0, task=BEND, every=9.0):
    return [work(every * k, every * k + lasting, 0, worker=worker, task=task, k=k) for k in range(n)]


def test_a_stoop_held_over_many_performances_is_one_hold():
    """20 performances of 9 s at 60 degrees, without a pause: 180 s = 3 min of the hour, and 1 min is allowed."""
    found = of(in_turn(20), made_plan(Bending(kind=Stooping)))
    assert found["longest_hold_s", "ana", "trunk"] == pytest.approx(180.0)
    assert found["static_hold_min_per_h", "ana", "trunk"] == pytest.approx(3.0)
    assert found["iso_11226_min_per_h", "ana", "trunk"] == pytest.approx(3.0)
    assert found["static_hold_min_per_h", "ben", "trunk"] == 0.0
    assert found["static_hold_min_per_h", "", "trunk"] == pytest.approx(1.5)


class Deep(Bends):
    """Bent by 25 degrees, and by 70 from a third to a half of the time."""

    course = staticmethod(lambda share: np.where((share > 1 / 3) & (share < 1 / 2), 70.0, 25.0))


def test_holds_at_two_angles_are_judged_each_at_its_own():
    """60 s of 25 degrees may be held for 217 s; 70 degrees not at all: of 48 s, 8 are beyond ISO 11226."""
    plan = made_plan(Bending(kind=Deep))
    found = of([work(0, 48, 0, worker=0, task=BEND, k=0)], plan)
    assert found["longest_hold_s", "ana", "trunk"] == pytest.approx(24.0, abs=1.0)
    assert found["static_hold_min_per_h", "ana", "trunk"] == pytest.approx(48 / 60)
    assert found["iso_11226_min_per_h", "ana", "trunk"] == pytest.approx(8 / 60, abs=1 / 60)


def test_short_holds_with_pauses_are_within_iso_11226():
    """60 degrees may be held for a minute, and each is held for 9 s."""
    found = of(in_turn(20, every=30.0), made_plan(Bending(kind=Stooping)))
    assert found["longest_hold_s", "ana", "trunk"] == pytest.approx(9.0)
    assert found["static_hold_min_per_h", "ana", "trunk"] == pytest.approx(3.0)
    assert found["iso_11226_min_per_h", "ana", "trunk"] == 0.0


def test_going_up_and_down_holds_nothing_and_moves_once_a_performance():
    """0 to 90 to 0 degrees in 9 s, beyond 20 for 7 of them: 6.67 bends a minute are too often for EN 1005-4."""
    found = of(in_turn(20), made_plan())
    assert found["longest_hold_s", "ana", "trunk"] == 0.0
    assert found["movements_per_min", "ana", "trunk"] == pytest.approx(60 / 9, rel=1e-3)
    assert found["en_1005_4_min_per_h", "ana", "trunk"] == pytest.approx(3.0 * 7 / 9, rel=0.05)


def test_a_bend_a_minute_is_never_too_often():
    """Once a minute is seldom: bending is then conditional at most, for however deep."""
    found = of(in_turn(20, every=60.0), made_plan())
    assert found["en_1005_4_min_per_h", "ana", "trunk"] == 0.0


def test_repetitions_by_hand():
    """12 bends of 9 s, one every 12 s, and 3 counts: 15 beginnings in 12 x 9 + 3 x 5 = 123 s of work."""
    rows = in_turn(12, every=12.0) + [work(1000 + 10 * k, 1005 + 10 * k, 0, worker=0, task=2, k=k) for k in range(3)]
    found = of(rows, made_plan())
    assert found["repetitions_per_min", "ana", ""] == pytest.approx(15 / (123 / 60))
    assert found["repetitions_per_min", "ana", "most"] == pytest.approx(12 / (123 / 60))
    assert np.isnan(found["repetitions_per_min", "ben", ""])


def test_who_is_away_has_no_hour():
    found = of([row(OFF, 0, 3600, worker=1), *in_turn(3)], made_plan())
    assert np.isnan(found["static_hold_min_per_h", "ben", "trunk"])
    assert found["static_hold_min_per_h", "", "trunk"] == found["static_hold_min_per_h", "ana", "trunk"]


def test_sentences_say_who_and_what_part():
    found = {
        ("iso_11226_min_per_h", "ana", "left_arm"): 3.04,
        ("iso_11226_min_per_h", "", "left_arm"): 1.5,
        ("en_1005_4_min_per_h", "ben", "trunk"): 0.01,
        ("en_1005_4_min_per_h", "ben", "neck"): 7.0,
    }
    assert list(sentences_of_holds(found)) == [
        "ana: 3.0 min/h beyond ISO 11226 (left arm).",
        "ben: 7.0 min/h beyond EN 1005-4 (neck).",
    ]


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
    (said,) = sentences_of_lifting({**values, ("lifts_out_of_range_share", "pick", ""): 0.25})
    assert said.endswith("(NIOSH); 25% of lifts are beyond the equation's range, whose edge stands for them: no bound.")
    (said,) = sentences_of_lifting({**values, ("lifts_out_of_range_share", "pick", ""): 0.0})
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
    assert list(sentences_of_lifting(values)) == [
        "In pick the load is 1.2 to 1.5 times the recommended limit (NIOSH).",
        "In place the load is up to 1.1 times the recommended limit (NIOSH), depending on what nobody said.",
        "All that ana lifts together comes to 2.0 times the recommended limit (NIOSH).",
    ]

"""Energy and rest allowances as figures."""

from dataclasses import replace

import numpy as np
import pytest

from opsim.kpi.catalogue import ENERGY, REST
from opsim.kpi.strain import energy_sentences as sentences
from opsim.log import BREAK, OFF, WALK
from opsim.plan.workers import Body
from tests.opsim.ergonomics.made_work import BEND, Bending, made_plan
from tests.opsim.kpi.made_logs import made, row, work
from tests.opsim.kpi.test_lifting import figures_of, plan_with


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

"""Figures sorted by what they are of."""

from opsim.kpi.catalogue import _OF, BODIES, EXPOSURE, FLOW, KINDS, KPIS, MATERIAL, PEOPLE, POSTURE, STATIONS, kind_of


def test_every_figure_is_of_one_kind():
    named = [kpi for kpis in _OF.values() for kpi in kpis]
    assert len(named) == len(set(named)) and set(named) <= set(KPIS)
    assert {kind_of(kpi) for kpi in KPIS} == set(KINDS)


def test_what_is_named_of_each_is_of_it():
    assert all(kind_of(kpi) == BODIES for kpi in (*POSTURE, *EXPOSURE))
    found = [kind_of(kpi) for kpi in ("throughput_per_h", "station_states", "stock", "fatigue_mean", "unheard_of")]
    assert found == [FLOW, STATIONS, MATERIAL, PEOPLE, FLOW]

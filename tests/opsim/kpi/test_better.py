from itertools import product

import pytest

from opsim.kpi.catalogue import (
    KPIS,
    LESS,
    LESS_IS_BETTER,
    LESS_OF,
    LESS_OF_LIMITS,
    MORE,
    MORE_IS_BETTER,
    better_of,
    read_asked,
)
from opsim.kpi.catalogue import AskedFigure as Asked


@pytest.mark.parametrize(
    "text, kpi, subject, part, better",
    [
        ("throughput_per_h", "throughput_per_h", "", "", MORE),
        (" rula_from_5_min_per_h/ana ", "rula_from_5_min_per_h", "ana", "", LESS),
        ("rula_from_5_min_per_h//at_most", "rula_from_5_min_per_h", "", "at_most", LESS),
        ("more worker_states/ana/wait", "worker_states", "ana", "wait", MORE),
        ("less  throughput_per_h", "throughput_per_h", "", "", LESS),
        ("worker_states/ana/work", "worker_states", "ana", "work", ""),
        ("trunk_flexion_share/ana/below_20", "trunk_flexion_share", "ana", "below_20", ""),
    ],
)
def test_a_figure_is_read_with_its_subject_its_part_and_the_way_that_is_better(text, kpi, subject, part, better):
    asked = read_asked(text)
    assert (asked.kpi, asked.subject, asked.part, asked.better) == (kpi, subject, part, better)


def test_what_is_read_is_written_as_it_was():
    for subject, part in product(("", "ana"), ("", "at_most")):
        asked = Asked("walked_m", subject, part)
        again = read_asked(asked.name)
        assert (again.kpi, again.subject, again.part) == (asked.kpi, asked.subject, asked.part)


def test_no_figure_is_better_both_ways_and_every_name_is_that_of_a_figure():
    assert not set(MORE_IS_BETTER) & set(LESS_IS_BETTER)
    assert set(MORE_IS_BETTER) | set(LESS_IS_BETTER) <= set(KPIS)
    assert not [kpi for kpi in MORE_IS_BETTER if kpi.startswith((*LESS_OF, *LESS_OF_LIMITS))]


def test_what_depends_on_who_asks_has_no_better_way():
    assert better_of("on_duty_h") == better_of("station_states") == better_of("posture_measured_share") == ""

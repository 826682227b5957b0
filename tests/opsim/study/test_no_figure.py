import pytest

from opsim.kpi.catalogue import KPIS
from opsim.study.compare import ONLY_WHERE, remedy


def test_nobody_is_sent_to_the_name_he_wrote():
    assert all(f"did you mean {kpi!r}" not in remedy(kpi, {*KPIS} - {kpi}) for kpi in KPIS)


@pytest.mark.parametrize(
    "kpi, said",
    [
        ("rest_taken_min_per_h", "people rest by need ('human: rest')"),
        ("overtime_h", "workers have shifts"),
        ("stock", "these results have none of it"),
        ("rula_mean", "'outputs' list it"),
        ("throughput_per_hour", "did you mean 'throughput_per_h'?"),
    ],
)
def test_why_there_is_none_of_a_figure_is_said(kpi, said):
    assert remedy(kpi, ("throughput_per_h", "walked_m")).endswith(said) or said in remedy(kpi, ("throughput_per_h",))


def test_only_figures_have_conditions():
    assert set(ONLY_WHERE) <= set(KPIS)

import numpy as np
import pytest
from plans import CELL, loaded

from opsim.kpi import Figure
from opsim.study import run_scenario
from opsim.study.intervals import NoSuchFigure, Precision, read_precision, replicate_until, t_interval
from opsim.study.replication import Replicated

WANTED = Precision("throughput_per_h", "", "", 0.05)


def until(values, most=1000, wanted=(WANTED,)):
    """(number used, numbers run, what was reached) where replication r gives values[r]."""
    ran = []

    def run(first, upto):
        ran.extend(range(first, upto))
        return [Replicated(r, [Figure("throughput_per_h", "", "", "1/h", values[r])], {}) for r in range(first, upto)]

    done, reached = replicate_until(wanted, most, run)
    return len(done), ran, reached


def naive(values, relative, most):
    for n in range(10, most + 1):
        interval = t_interval(values[:n])
        if interval.half_width / abs(interval.mean) <= relative / (1 + relative):
            return n
    return most


@pytest.mark.parametrize("seed", range(12))
def test_it_stops_at_the_first_number_that_is_enough_however_they_came_in_batches(seed):
    values = np.random.default_rng(seed).normal(100, 30, 1000)
    n, ran, (reached,) = until(values)
    assert n == naive(values, 0.05, 1000) and ran == list(range(len(ran))) and len(ran) >= n
    assert reached.reached and reached.n == n


def test_ten_are_run_even_where_two_would_do():
    assert until([100.0, 100.1] * 20)[0] == 10
    n, _, (reached,) = until([5.0] * 20)
    assert n == 10 and reached.found == 0 and reached.reached


def test_the_most_that_is_allowed_ends_it_and_is_said():
    n, ran, (reached,) = until(np.random.default_rng(0).normal(100, 90, 60), most=60)
    assert n == 60 == len(ran) and not reached.reached and reached.words.endswith("not reached")
    assert until([100.0] * 20, most=4)[0] == 4 and not until([100.0] * 20, most=4)[2][0].reached


@pytest.mark.parametrize("value", [0.0, np.nan])
def test_a_mean_of_nothing_is_known_only_where_it_never_varies(value):
    n, _, (reached,) = until([value, -value, *[value] * 30] + [1.0, -1.0] * 10, most=40)
    assert (n, reached.reached) == ((10, True) if value == 0 else (40, False))


def test_every_precision_that_is_wanted_must_be_reached():
    values = np.random.default_rng(1).normal(100, 30, 1000)
    loose = Precision("throughput_per_h", "", "", 0.2)
    assert until(values, wanted=(loose, WANTED))[0] == until(values)[0] > until(values, wanted=(loose,))[0]


def test_a_figure_that_the_run_does_not_have_is_named():
    with pytest.raises(NoSuchFigure, match="did you mean 'throughput_per_h'"):
        until([1.0] * 20, wanted=(Precision("throughput_per_h", "carton", "", 0.1),))


@pytest.mark.parametrize(
    "text, found",
    [
        ("throughput_per_h=1%", Precision("throughput_per_h", "", "", 0.01)),
        ("worker_states/ana/work = 2.5 %", Precision("worker_states", "ana", "work", 0.025)),
    ],
)
def test_a_precision_is_read(text, found):
    assert read_precision(text) == found


@pytest.mark.parametrize(
    "text, said",
    [
        ("throughput_per_h", "expected FIGURE=PER CENT"),
        ("throughput_per_h=1", "expected FIGURE=PER CENT"),
        ("throughput_per_h=0%", "expected FIGURE=PER CENT"),
        ("throughput_per_h=1.2.3%", "expected FIGURE=PER CENT"),
        ("troughput_per_h=1%", "did you mean 'throughput_per_h'"),
    ],
)
def test_a_precision_that_cannot_be_meant_is_refused(text, said):
    with pytest.raises(ValueError, match=said):
        read_precision(text)


def test_a_run_to_a_precision_says_how_many_it_took_and_why(tmp_path):
    cell = loaded(CELL.replace("horizon: 2 h", "horizon: 30 min"))
    wanted = [Precision("throughput_per_h", "", "", 0.3)]
    result = run_scenario(cell, folder=tmp_path, processes=1, precision=wanted)
    n = result.summary["replications"]
    (found,) = result.summary["precision"]
    assert n > 10 and found["reached"] and found["found"] <= 0.3 / 1.3
    assert f"replications: {n}" in (tmp_path / "scenario.resolved.yaml").read_text()
    assert any(f"replications: {n}, as many as needed" in line["says"] for line in result.summary["assumptions"])
    fixed = run_scenario(cell, folder=tmp_path, processes=1, replications=n)
    assert fixed.summary["kpis"] == result.summary["kpis"]

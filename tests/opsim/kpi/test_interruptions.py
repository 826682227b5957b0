"""How often work was broken off, and what became of it."""

from plans import plan

from opsim.log import SETUP
from tests.opsim.kpi.made_logs import found, made, row, work
from tests.opsim.laws.test_progress import FLOOR, piece

HOUR = FLOOR.replace("horizon: 100 s", "horizon: 2 h, warm_up: 1 h")


def counts(*rows, text=HOUR):
    p = plan(text)
    values = found(made(rows, p), p)
    return {(of, part): v for (kpi, of, part), v in values.items() if kpi == "interruptions_per_h" and v}


def test_pieces_are_counted_by_what_became_of_the_rest_where_they_ended_in_the_window():
    resumed = [piece(4000, 4004, 0, 0.4), piece(4050, 4056, 0.4, 1)]
    handed = [work(5000, 5004, 1, job=1, worker=0, k=5, task=1, progress=(0, 0.4))]
    handed += [work(5004, 5010, 1, job=1, worker=1, k=6, task=1, progress=(0.4, 1))]
    early = [work(100, 104, 0, job=2, worker=0, k=7, progress=(0, 0.4))]
    assert counts(*resumed, *handed, *early) == {
        ("", ""): 2,
        ("", "resumed"): 1,
        ("a", "resumed"): 1,
        ("", "handed_over"): 1,
        ("b", "handed_over"): 1,
    }


def test_what_the_horizon_cuts_off_is_not_broken_off_and_set_ups_are_no_work():
    assert counts(work(7196, 7200, 0, worker=0, progress=(0, 0.4))) == {}
    assert counts(row(SETUP, 4000, 4004, worker=0, station=0, job=0, task=0, k=0, progress=(0, 0.4))) == {}

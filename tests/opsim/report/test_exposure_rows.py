import math

from opsim.report.sections.exposure_summary import Bar, bar_of_all, bars_by, bars_of_regions, bars_of_workers
from tests.opsim.report.made_exposure import ROWS, by, levels


def test_a_worker_has_a_bar_with_what_is_sure_and_what_may_be():
    ana, ben = bars_of_workers(ROWS)
    assert ana == Bar("ana", 6.0, 25.0, 30.0, 24.5, 25.5) and ben.subject == "ben" and ana.is_open
    assert bar_of_all(ROWS).five == 20.0


def test_what_is_at_no_station_is_shown_only_where_it_is_something():
    assert [bar.subject for bar in bars_by(ROWS, "exposure_by_station")] == ["shelf"]
    nowhere = by("exposure_by_station", "none", 0.0, 0.0, 1.0)
    assert [bar.subject for bar in bars_by(nowhere, "exposure_by_station")] == ["none"]


def test_regions_come_by_length_and_without_those_that_bring_in_nothing():
    assert [(bar.subject, bar.five, bar.is_open) for bar in bars_of_regions(ROWS)] == [
        ("trunk", 12.0, False),
        ("load", 8.0, False),
    ]


def test_what_was_never_known_has_no_bar_and_one_replication_no_interval():
    unknown = [{**row, "mean": None} for row in ROWS]
    assert bars_of_workers(unknown) == [] and bar_of_all(unknown) is None and bar_of_all([]) is None
    once = [{**row, "low": None, "high": None, "half_width": None} for row in levels("ana", 1.0, 2.0, 3.0)]
    (bar,) = bars_of_workers(once)
    assert math.isnan(bar.low) and bar.five == 2.0

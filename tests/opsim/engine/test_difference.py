"""Planted differences between two logs of one run."""

from dataclasses import replace

import numpy as np
import pytest
from plans import line, ran
from stand_in_engine import spoilt

from opsim.engine.difference import AROUND, difference
from opsim.log import COLUMNS, WORK


@pytest.fixture(scope="module")
def log():
    return ran(line(2, 1, horizon="5 min", warm_up="0 s"))[0]


def work(log, number=20):
    """The number of a row of work."""
    return int(np.flatnonzero(log["kind"] == WORK)[number])


def without(log, row):
    return log.where(np.arange(len(log)) != row)


def test_a_log_is_the_same_as_its_copy(log):
    assert len(log) > 100 and difference(log, log.where(np.arange(len(log)))) is None


def test_the_last_bit_of_a_time_is_found(log):
    row = work(log)
    late = np.nextafter(log["end_s"][row], np.inf)
    found = difference(log, spoilt(log, row, "end_s", late))
    assert (found.row, found.columns) == (row, ("end_s",))
    cell = {cell.column: cell for cell in found.cells()}["end_s"]
    assert cell.differs and float(cell.one) == log["end_s"][row] and float(cell.other) == late


def test_only_the_first_row_that_differs_is_told(log):
    both = spoilt(spoilt(log, work(log, 30), "job", 9999), work(log, 10), "job", 8888)
    assert difference(log, both).row == work(log, 10)


def test_a_wrong_worker_is_told_by_name(log):
    row = work(log)
    found = difference(log, spoilt(log, row, "worker", 1 - log["worker"][row]))
    cells = [cell for cell in found.cells() if cell.differs]
    assert [(cell.column, {cell.one, cell.other}) for cell in cells] == [("worker", {"w1", "w2"})]
    assert found.said == f"row {row:,} differs in worker"


def test_a_number_that_no_name_has_is_told_all_the_same(log):
    found = difference(log, spoilt(log, work(log), "station", 77))
    assert next(cell.other for cell in found.cells() if cell.differs) == "no name: 77"


def test_nothing_against_a_number_differs_and_nothing_against_nothing_does_not(log):
    row = int(np.flatnonzero(np.isnan(log["progress_to"]))[3])
    found = difference(log, spoilt(log, row, "progress_to", 1.0))
    assert (found.row, found.columns) == (row, ("progress_to",))
    assert [(cell.one, cell.other) for cell in found.cells() if cell.differs] == [("", "1.0")]
    other_nan = np.array([0x7FF8000000000001]).view(np.float64)[0]
    assert difference(log, spoilt(log, row, "progress_to", other_nan)) is None


def test_the_sign_of_zero_is_a_difference(log):
    row = int(np.flatnonzero(log["start_s"] == 0.0)[0])
    assert difference(log, spoilt(log, row, "start_s", -0.0)).columns == ("start_s",)


def test_a_row_that_is_missing_is_found_where_it_is_missing(log):
    row = work(log)
    found = difference(log, without(log, row))
    assert found.row == row and found.columns
    around = list(found.around())
    assert [whose for whose, _, _ in around] == ["both"] * AROUND + ["one"] * (AROUND + 1) + ["other"] * (AROUND + 1)
    rows = {(whose, number): shown for whose, number, shown in around}
    assert rows["one", row + 1] == rows["other", row]


@pytest.mark.parametrize("longer", ["one", "other"])
def test_a_last_row_that_is_missing_is_told_against_nothing(log, longer):
    short = without(log, len(log) - 1)
    found = difference(log, short) if longer == "one" else difference(short, log)
    assert found.row == len(log) - 1 and "the first" in found.said and found.columns == ()
    assert all(cell.differs for cell in found.cells()) and {len(found.cells())} == {len(COLUMNS)}
    assert {whose for whose, _, _ in found.around()} == {"both", longer}


def test_the_first_row_of_all_has_nothing_before_it(log):
    found = difference(log, spoilt(log, 0, "job", 9999))
    assert found.row == 0 and "both" not in {whose for whose, _, _ in found.around()}


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"replication": 3}, "replication 0 and 3"),
        ({"horizon_s": 301.0}, "horizon 300.0 s and 301.0 s"),
        ({"names": {}}, "the names of column worker"),
    ],
)
def test_logs_of_other_runs_differ_before_their_rows(log, change, said):
    found = difference(log, replace(log, **change))
    assert found.row is None and said in found.said and found.cells() == [] and list(found.around()) == []


def test_a_column_of_another_type_is_told(log):
    columns = {**log.columns, "job": log["job"].astype(np.int32)}
    assert difference(log, replace(log, columns=columns)).said == "column job holds int64 and int32"

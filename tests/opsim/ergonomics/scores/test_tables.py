"""The published tables: they rise, but for OWAS where it is known not to."""

import numpy as np
import pytest

from opsim.ergonomics.scores.tables import (
    OWAS,
    OWAS_ALTERNATIVES,
    REBA_A,
    REBA_B,
    REBA_C,
    RULA_A,
    RULA_B,
    RULA_C,
    owas_table,
)
from tests.opsim.ergonomics.reference import reference

RISING = {
    **{f"RULA A {name}": table for name, table in RULA_A.items()},
    "RULA B": RULA_B,
    "RULA C": RULA_C,
    "REBA A": REBA_A,
    "REBA B": REBA_B,
    "REBA C": REBA_C,
}


@pytest.mark.parametrize("name", RISING)
def test_the_tables_of_rula_and_reba_rise_with_every_code(name):
    for axis in range(RISING[name].ndim):
        assert np.all(np.diff(RISING[name], axis=axis) >= 0), axis


@pytest.mark.parametrize("disputed", [(), *((code,) for code in OWAS_ALTERNATIVES)])
def test_owas_rises_with_arms_and_load(disputed):
    table = owas_table(disputed)
    assert np.all(np.diff(table, axis=1) >= 0) and np.all(np.diff(table, axis=3) >= 0)


def falls(axis):
    """{digit: in how many cells OWAS falls from it to the next}, of back (0) or legs (2)."""
    digits, cells = np.unique(np.argwhere(np.diff(OWAS, axis=axis) < 0)[:, axis] + 1, return_counts=True)
    return dict(zip(digits.tolist(), cells.tolist()))


def test_owas_falls_from_a_bent_back_to_a_twisted_one_and_with_the_legs_and_nowhere_else():
    assert falls(0) == {2: 35}  # 2111 is 2, 3111 is 1
    assert falls(2) == {1: 13, 5: 19, 6: 15}  # 2311 is 3, 2321 is 2; 1151 is 2, 1161 is 1; 2363 is 4, 2371 is 2


def test_the_worksheet_of_2000_is_lower_in_31_cells():
    less = RULA_A["published"] - RULA_A["worksheet2000"]
    assert [int((less == points).sum()) for points in (-1, 0, 1, 2)] == [0, 113, 30, 1]


def test_disputed_categories_are_the_other_ones_where_asked():
    assert OWAS[2, 2, 6, 2] == 1 and owas_table(("3373",))[2, 2, 6, 2] == 2
    assert OWAS[3, 0, 2, 1] == 2 and owas_table(("4132",))[3, 0, 2, 1] == 3
    assert (owas_table(("3373", "4132")) != OWAS).sum() == 2


def test_tables_cannot_be_written_to():
    for table in (*RISING.values(), OWAS):
        with pytest.raises(ValueError, match="read-only"):
            table[(0,) * table.ndim] = 9


def test_no_cell_is_mistyped():
    known = reference("ergonomic_tables.json")
    for ours, theirs in (
        (RULA_A["published"], known["rula"]["table_a"]),
        (RULA_A["worksheet2000"], known["rula"]["table_a_variant_2000_worksheet"]["values"]),
        (RULA_B, known["rula"]["table_b"]),
        (RULA_C, known["rula"]["table_c"]),
        (REBA_A, known["reba"]["table_a"]),
        (REBA_B, known["reba"]["table_b"]),
        (REBA_C, known["reba"]["table_c"]),
        (OWAS, known["owas"]["table"]),
    ):
        assert np.array_equal(ours, theirs)
    assert {cell["code"]: cell["alternative"] for cell in known["owas"]["disputed_cells"]} == OWAS_ALTERNATIVES

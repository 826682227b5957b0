import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from opsim.viewer.skeletons import DTYPES, Columns, unpacked_column, unpacked_columns


def column_of(dtype):
    return st.tuples(st.just(dtype), arrays(f"<{dtype}", st.integers(0, 20)))


COLUMN = st.sampled_from(DTYPES).flatmap(column_of)


@given(st.lists(COLUMN, max_size=6))
def test_columns_come_back_as_they_went_in(given):
    columns = Columns()
    for number, (dtype, values) in enumerate(given):
        columns.add(f"c{number}", dtype, values)
    data = columns.close()
    found = unpacked_columns(columns.table, data)
    for number, (_, values) in enumerate(given):
        assert found[f"c{number}"].tobytes() == values.tobytes()
    assert all(offset % 8 == 0 for _, offset, _ in columns.table.values()) and len(data) % 8 == 0


def test_the_low_bytes_come_first():
    columns = Columns()
    columns.add("a", "u2", np.array([0x0102, 0x0304]))
    assert columns.close()[:4] == bytes([2, 4, 1, 3])
    assert unpacked_column(bytes([2, 4, 1, 3]), "u2", 0, 2).tolist() == [0x0102, 0x0304]


def test_a_number_that_does_not_fit_is_refused():
    with pytest.raises(ValueError, match="column a: 0 to 70000 do not fit into u2"):
        Columns().add("a", "u2", np.array([0, 70_000]))


def test_a_column_is_added_once():
    columns = Columns()
    columns.add("a", "u1", np.zeros(3))
    with pytest.raises(ValueError, match="column a"):
        columns.add("a", "u1", np.zeros(3))

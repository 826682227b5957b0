"""Rows in their order, without a sort of all of them: as the sort of all of them has it."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from opsim.engine.fast_engine.columns import CHUNK, columns_of
from opsim.engine.fast_engine.machine.layouts import LAYOUTS
from opsim.engine.fast_engine.parts.rows import ROW_BYTES
from opsim.log import COLUMNS, ORDER

FIELDS = LAYOUTS["Row"].fields
ROW = np.dtype([(name, np.float64 if FIELDS[name].kind == "float" else np.int64) for name in COLUMNS])
rows = st.tuples(*([st.integers(0, 3)] * len(ORDER)))


def chunks_of(found):
    """Rows as the engine leaves them, in chunks of bytes."""
    assert ROW.itemsize == ROW_BYTES
    packed = np.zeros(max(1, -(-len(found) // CHUNK)) * CHUNK, ROW)
    for i, row in enumerate(found):
        for name, value in zip(ORDER, row):
            packed[name][i] = value
        packed["performance_id"][i], packed["pace_shift"][i] = i, np.nan
    return [chunk.view(np.uint8).reshape(-1) for chunk in packed.reshape(-1, CHUNK)]


def sorted_whole(found):
    """``performance_id`` of the rows as a stable sort of them all has them."""
    return sorted(range(len(found)), key=lambda i: found[i])


@settings(max_examples=150, deadline=None)
@given(st.lists(rows, max_size=60), st.booleans())
def test_the_order_is_that_of_a_stable_sort(found, as_they_end):
    if as_they_end:
        found = sorted(found, key=lambda row: row[0])
    columns = columns_of(chunks_of(found), len(found))
    assert columns["performance_id"].tolist() == sorted_whole(found)
    assert all(columns[name].dtype == kind for name, kind in COLUMNS.items())
    assert np.isnan(columns["pace_shift"]).all()


def test_rows_of_several_chunks():
    found = [(i // 3, 0, i % 2, 0, 0, 0, 0, 0) for i in range(2 * CHUNK + 17)]
    columns = columns_of(chunks_of(found), len(found))
    assert columns["performance_id"].tolist() == sorted_whole(found)

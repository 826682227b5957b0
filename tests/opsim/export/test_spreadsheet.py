import re

import duckdb
import pytest
from hypothesis import given
from hypothesis import strategies as st

from opsim.export.tables import DANGEROUS, guarded, identifier

CONNECTION = duckdb.connect()
"""One for all examples: to open a database costs more than to ask it."""
BEGINS = st.sampled_from(["", "=", "+", "-", "@", " =", "\t", "\r\n@", "a="])


@given(st.builds(str.__add__, BEGINS, st.text(max_size=6)))
def test_no_text_is_a_formula_and_an_apostrophe_is_all_that_is_added(text):
    query = f"SELECT {guarded('name', 'VARCHAR')} FROM (SELECT ? AS name)"
    (found,) = CONNECTION.execute(query, [text]).fetchone()
    assert found in (text, f"'{text}")
    assert found.lstrip(" \t\r\n\f\v")[:1] not in ("=", "+", "-", "@") or found.startswith("'")
    assert (found != text) == bool(re.search(DANGEROUS, text))


@pytest.mark.parametrize("text", ["=1+1", "+1", "-1", "@SUM(A1)", " =1", "\t=1", "\rname"])
def test_what_a_spreadsheet_would_compute_is_guarded(text):
    query = f"SELECT {guarded('name', 'VARCHAR')} FROM (SELECT ? AS name)"
    assert CONNECTION.execute(query, [text]).fetchone() == (f"'{text}",)


def test_numbers_stay_numbers():
    assert guarded("value", "DOUBLE") == '"value"'


def test_a_column_with_quotes_in_its_name_is_one_name():
    assert identifier('a"b') == '"a""b"'

import pytest
from hypothesis import given
from hypothesis import strategies as st

from opsim.csv_input import RecordedError, read_times, resolve_times


def times(tmp_path, text, column=None):
    (tmp_path / "times.csv").write_text(text, encoding="utf-8")
    return read_times(resolve_times("times.csv", tmp_path), column)


@pytest.mark.parametrize(
    ("text", "column", "expected"),
    [
        ("3\n4.5\n\n5\n", None, [3.0, 4.5, 5.0]),
        ("duration_s\n3\n4\n", None, [3.0, 4.0]),
        ("worker,duration_s\nana,3\nben,4\n", "duration_s", [3.0, 4.0]),
        ("worker;duration_s\nana;3\n", "duration_s", [3.0]),
        ("1,2\n3,4\n", "2", [2.0, 4.0]),
    ],
)
def test_a_column_is_read_in_its_order(tmp_path, text, column, expected):
    assert times(tmp_path, text, column) == expected


@pytest.mark.parametrize(
    ("text", "column", "said"),
    [
        ("", None, "'times.csv' is empty; fill it, or name another file"),
        ("duration_s\n", None, "'times.csv' holds no times"),
        ("t\n3\n-1\n", None, "'times.csv' line 3: '-1' is not a positive number of seconds"),
        ("t\n3\n\n3 s\n", None, "'times.csv' line 4: '3 s' is not a positive number of seconds"),
        ("t\ninf\n", None, "'times.csv' line 2: 'inf' is not a positive number of seconds"),
        ("t\n1\n1e10\n", None, "'times.csv' line 3: '1e10' is more than 2^33 s (272 years)"),
        ("a,b\n1,2\n", None, "'times.csv' has 2 columns; add 'column:' with one of: a, b"),
        ("duration,b\n1,2\n", "duratoin", "no column 'duratoin' in 'times.csv'; did you mean 'duration'?"),
        ("a,b\n1\n", "b", "'times.csv' line 2: '' is not a positive number of seconds"),
    ],
)
def test_a_broken_file_is_answered_with_its_line(tmp_path, text, column, said):
    with pytest.raises(RecordedError) as caught:
        times(tmp_path, text, column)
    assert str(caught.value) == said


def test_a_missing_file_is_answered_with_the_nearest(tmp_path):
    (tmp_path / "times.csv").write_text("1\n")
    with pytest.raises(RecordedError, match=r"no file 'tmes.csv' in the scenario's folder; did you mean 'times.csv'\?"):
        resolve_times("tmes.csv", tmp_path)


@given(raw=st.binary(max_size=60))
def test_any_bytes_are_times_or_a_recorded_error(tmp_path_factory, raw):
    path = tmp_path_factory.mktemp("csv") / "x.csv"
    path.write_bytes(raw)
    try:
        assert min(read_times(path)) > 0
    except RecordedError as error:
        assert error.message


def test_a_file_too_large_to_be_times_is_refused_unread(tmp_path, monkeypatch):
    monkeypatch.setattr("opsim.csv_input.MOST_BYTES", 10)
    with pytest.raises(RecordedError, match=r"'times.csv' is larger than 0 MB"):
        times(tmp_path, "duration_s\n1\n2\n")

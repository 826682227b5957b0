"""Names of columns: a name and an axis, however they are written, in time that grows with their length."""

import pytest

from emulator.recordings.columns import _split


@pytest.mark.parametrize(
    ("label", "found"),
    [
        ("LKNE_x", ("LKNE", "x")),
        ("LKNE X (mm)", ("LKNE", "x")),
        ("LKNE.pos.Y", ("LKNE", "y")),
        ("left knee position z", ("left knee", "z")),
        ("ana:LKNE-z [m]", ("ana:LKNE", "z")),
        ("LKNEx", ("LKNE", "x")),
        ("nose_score", ("nose", "score")),
        ("nose_p", ("nose", "score")),
        ("hip", ("hip", "")),
        ("x", ("x", "")),
        ("pos_x", ("pos", "x")),
        ("time", ("time", "")),
        ("Frame#", ("Frame#", "")),
    ],
)
def test_a_label_is_a_name_and_an_axis(label, found):
    assert _split(label) == found


@pytest.mark.parametrize("label", ["a" + "_" * 50_000 + "k", "a" + "_p" * 25_000, "x(" * 25_000, "pos_" * 12_000])
def test_a_hostile_label_is_split(label):
    """Where time grows with the square or the cube of the length, as it did once, this takes minutes to hours."""
    name, _ = _split(label)
    assert label.startswith(name)

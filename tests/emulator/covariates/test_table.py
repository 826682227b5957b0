from dataclasses import replace

import numpy as np
import pytest

from emulator.covariates.table import asked_table, table_of, unused_columns
from emulator.synthetic.tasks import make


def with_covariates(*rows):
    """Two workers, two repetitions each, with these covariates."""
    motions = make("reach", 2, 2)[0]
    return replace(motions, motions=tuple(replace(m, covariates=row) for m, row in zip(motions.motions, rows)))


ANNA = {"cov_height_m": 1.6, "cov_sex": "female", "cov_pace": 0.9, "cov_vmax": 3.0}
BEN = {"cov_stature_m": 1.8, "cov_sex": "m", "cov_pace": float("nan"), "cov_vmax": 4.0}


def test_one_row_a_repetition_with_nan_where_unknown():
    table = table_of(with_covariates(ANNA, ANNA | {"cov_pace": 1.1}, BEN, BEN))
    assert table.names == ("height_m", "pace")
    assert np.array_equal(table.numeric, [[1.6, 0.9], [1.6, 1.1], [1.8, np.nan], [1.8, np.nan]], equal_nan=True)
    assert table.category == ("f", "f", "m", "m")
    assert table.groups.tolist() == [0, 0, 1, 1]


def test_people_have_the_mean_of_what_is_known_of_them():
    table = table_of(with_covariates(ANNA, ANNA | {"cov_pace": 1.1}, BEN, BEN))
    assert np.allclose(table.of_people().numeric, [[1.6, 1.0], [1.8, np.nan]], equal_nan=True)
    assert table.body(0) == {"height_m": 1.6, "pace": 1.0, "sex": "f"}
    assert table.body(1) == {"height_m": 1.8, "sex": "m"}


def test_a_sex_that_one_repetition_does_not_know_is_that_of_the_others():
    table = table_of(with_covariates(ANNA | {"cov_sex": None}, ANNA, BEN, BEN | {"cov_sex": ""}))
    assert table.category == (None, "f", "m", None)
    assert table.of_people().category == ("f", "m")
    assert table.body(0)["sex"] == "f"


def test_without_a_worker_the_others_are_numbered_anew():
    table = table_of(with_covariates(ANNA, ANNA, BEN, BEN)).without(0)
    assert table.workers == ("w2",)
    assert table.groups.tolist() == [0, 0]
    assert table.category == ("m", "m")


def test_any_numeric_covariate_can_be_named():
    table = table_of(with_covariates(ANNA, ANNA, BEN, BEN), ["cov_vmax", "height"])
    assert table.names == ("vmax", "height_m")
    assert table.numeric[:, 0].tolist() == [3, 3, 4, 4]


def test_recordings_without_covariates_have_none():
    table = table_of(with_covariates({}, {}, {}, {}))
    assert table.names == ()
    assert table.numeric.shape == (4, 0)
    assert table.category == (None,) * 4


def test_all_mistakes_are_said_with_repetition_and_covariate():
    rows = (ANNA | {"cov_height_m": 160.0}, ANNA | {"cov_sex": "m"}, BEN, BEN | {"cov_pace": "quick"})
    with pytest.raises(ValueError) as wrong:
        table_of(with_covariates(*rows), ["height_m", "pace", "vmx"])
    assert str(wrong.value).splitlines() == [
        "reach: no covariate 'vmx'; did you mean 'vmax'?",
        "reach: w1/r1: cov_height_m: found 160, expected 0.9 to 2.4 (metres); did you mean 1.6?",
        "reach: w2/r2: cov_pace: found 'quick', expected a number",
        "reach: worker 'w1': sex: found f and m, expected one",
    ]


def four_people(**columns):
    """Four workers, a repetition each; a column of four values by name."""
    motions = make("reach", 4, 1)[0]
    rows = [{f"cov_{name}": values[i] for name, values in columns.items()} for i in range(4)]
    return replace(motions, motions=tuple(replace(m, covariates=row) for m, row in zip(motions.motions, rows)))


REACHES = four_people(
    height=(1.6, 1.7, 1.8, 1.9), arm=(0.5, 0.6, 0.6, 0.7), correct=(1, 1, 1, 1), style=("a", "b", "a", "b")
)


def test_a_column_asked_for_stands_beside_the_body():
    assert asked_table(REACHES, ["arm"]).names == ("height_m", "arm")


@pytest.mark.parametrize(
    ("motions", "name", "said"),
    [
        (REACHES, "amr", "no covariate 'amr'; did you mean 'arm'?"),
        (REACHES, "correct", "'correct': found it the same for everybody"),
        (REACHES, "style", "'style': found 'a', expected numbers"),
        (with_covariates(ANNA, ANNA, BEN, BEN), "vmax", "'vmax': found recordings of 2 people, expected 4 or more"),
    ],
)
def test_a_column_that_can_tell_nothing_is_refused_by_name(motions, name, said):
    with pytest.raises(ValueError) as caught:
        asked_table(motions, [name])
    assert said in str(caught.value)


def test_columns_that_nothing_uses_are_named():
    assert unused_columns(REACHES) == ["arm", "correct", "style"]
    assert unused_columns(replace(REACHES, selection="cov_correct==1 and style in (a, b)"), ["arm"]) == []

import json
from dataclasses import fields

import numpy as np
import pytest

from emulator.covariates.model import CovariateModel
from emulator.covariates.serialise import pack, unpack
from tests.emulator.covariates.cases import NAMES, people


def made(with_sex=True):
    rng = np.random.default_rng(0)
    x = np.column_stack([people(12, rng), np.ones(12)])
    y = rng.standard_normal((12, 4)) + 3 * x[:, :1]
    return CovariateModel.fit(y, x, (*NAMES, "shoe"), ["f", "m"] * 6 if with_sex else None)


@pytest.mark.parametrize("with_sex", [True, False])
def test_a_model_comes_back_bit_for_bit(with_sex):
    model = made(with_sex)
    plain, arrays = pack(model)
    again = unpack(json.loads(json.dumps(plain)), arrays)
    for part in fields(CovariateModel):
        one, other = getattr(model, part.name), getattr(again, part.name)
        if isinstance(one, np.ndarray):
            assert one.tobytes() == other.tobytes(), part.name
        elif part.name != "gaussian":
            assert one == other
    assert np.array_equal(model.predict({"height_m": 1.0}), again.predict({"height_m": 1.0}))
    assert all(array.dtype.kind in "fi" for array in arrays.values())


def test_all_that_is_missing_or_misshapen_is_named():
    plain, arrays = pack(made())
    with pytest.raises(ValueError, match="has no names, slope"):
        unpack({k: v for k, v in plain.items() if k != "names"}, {k: v for k, v in arrays.items() if k != "slope"})
    with pytest.raises(ValueError) as wrong:
        unpack(plain, arrays | {"low": np.zeros(3), "mean": np.zeros(2)})
    assert str(wrong.value).splitlines() == [
        "covariates: stored low: found (3,), expected (4,)",
        "covariates: stored mean: found (2,), expected (5,)",
    ]

"""Statistics against the cases of ``known_answers.json``."""

import json

import numpy as np
import pytest
from recordings import reference

from opsim.study.intervals import t_interval
from opsim.study.long_run.warm_up import mser


def case(name: str) -> dict:
    entries = json.loads(reference("known_answers.json").read_text())
    return next(entry for entry in entries if entry["name"] == name)


def test_mser_cuts_the_step_series_where_the_reference_does():
    expected = case("MSER-5, step series")["expected"]["truncation"]
    series = np.r_[np.full(100, 10.0), np.tile([0.0, 1.0, 0.0, 1.0, 0.5], 180)]
    assert mser(series) == expected


def test_the_t_interval_is_that_of_the_reference():
    expected = case("t interval from 10 replications")["expected"]
    interval = t_interval([1.53, 1.66, 1.24, 2.34, 2.00, 1.69, 2.69, 2.86, 1.70, 2.60], 0.90)
    assert interval.mean == pytest.approx(expected["mean"], abs=1e-9)
    assert interval.half_width == pytest.approx(expected["half_width"], abs=1e-9)

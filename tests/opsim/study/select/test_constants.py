"""The constants of two-stage procedures against quadratures done elsewhere and against each other."""

import json
from pathlib import Path

import numpy as np
import pytest

from opsim.study.select.constants import check_confidence, dudewicz_dalal_h, kn_eta, rinott_h

H1 = {
    (2, 0.90): 1.8957,
    (2, 0.95): 2.4525,
    (5, 0.90): 2.7471,
    (5, 0.95): 3.2580,
    (10, 0.90): 3.1820,
    (10, 0.95): 3.6788,
}
H = {(2, 0.95, 20): 2.4525, (10, 0.95, 20): 3.8753, (10, 0.90, 20): 3.4374, (5, 0.95, 10): 3.6926}


@pytest.mark.parametrize(("k", "confidence"), H1)
def test_dudewicz_and_dalals_constant_is_that_of_the_table(k, confidence):
    assert dudewicz_dalal_h(k, confidence, 20) == pytest.approx(H1[k, confidence], abs=1e-4)


@pytest.mark.parametrize("asked", H)
def test_rinotts_constant_is_that_of_the_double_integral(asked):
    assert rinott_h(*asked) == pytest.approx(H[asked], abs=1e-4)


@pytest.mark.parametrize("n0", [2, 3, 10, 60])
def test_both_constants_are_the_same_for_two_systems(n0):
    """Given both spreads, the difference of two Student's t is normal: Rinott's integral, the other way round."""
    h = dudewicz_dalal_h(2, 0.95, n0)
    assert rinott_h(2, 0.95, n0) == pytest.approx(h, rel=2e-3 if n0 == 2 else 1e-5)


def test_with_many_replications_the_constants_are_those_of_known_spreads():
    """Bechhofer 1954: for k = 2, sqrt(2) times the normal quantile."""
    assert rinott_h(2, 0.95, 5000) == pytest.approx(np.sqrt(2) * 1.6449, rel=1e-3)


@pytest.mark.parametrize("function", [rinott_h, dudewicz_dalal_h])
def test_more_systems_and_more_confidence_need_a_larger_constant(function):
    assert function(3, 0.9, 15) < function(4, 0.9, 15) < function(4, 0.95, 15) < function(4, 0.95, 8)


def test_eta_is_the_root_of_its_equation():
    eta = kn_eta(9, 0.05 / 9)
    assert 0.5 * (1 + 2 * eta) ** (-9 / 2) == pytest.approx(0.05 / 9, rel=1e-12)


@pytest.mark.parametrize("confidence", [0.25, 0.2, 1.0, 1.5, float("nan")])
def test_a_confidence_that_a_guess_has_too_is_refused(confidence):
    with pytest.raises(ValueError, match=r"between 0\.25 .* and 1, found"):
        check_confidence(confidence, 4)


REFERENCE = Path(__file__).parents[5] / "shared" / "data" / "reference" / "known_answers.json"


@pytest.mark.skipif(not REFERENCE.exists(), reason="shared data is not here")
def test_the_constants_are_those_of_the_reference():
    entries = {entry["name"]: entry["expected"] for entry in json.loads(REFERENCE.read_text())}
    for said, h in entries["Dudewicz-Dalal constant h1"].items():
        k, p = (float(part.split("=")[1]) for part in said.split(","))
        assert dudewicz_dalal_h(int(k), p, 20) == pytest.approx(h, abs=1e-5)
    for said, h in entries["Rinott constant h"].items():
        k, p, n0 = (float(part.split("=")[1]) for part in said.split(","))
        assert rinott_h(int(k), p, int(n0)) == pytest.approx(h, abs=1e-5)

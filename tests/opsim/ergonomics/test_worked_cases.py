"""Every worked case of the reference, exactly; skeletons through their positions and the kernel, and by hand."""

import json

import numpy as np
import pytest

from opsim.ergonomics.angles import CANONICAL
from opsim.ergonomics.measures import measures_of_positions
from opsim.ergonomics.options import USUAL, Options
from opsim.ergonomics.scores.explain import explain
from opsim.ergonomics.scores.owas import owas
from opsim.ergonomics.scores.reba import reba
from opsim.ergonomics.scores.rula import rula
from opsim.ergonomics.scores.scoring import NOTHING_OPEN, Bounds, score
from tests.opsim.ergonomics.bodies import arm, bent, moved, turn
from tests.opsim.ergonomics.reference import WHERE

REFERENCE = WHERE / "ergonomic_cases.json"


def cases(method):
    if not REFERENCE.exists():
        return [pytest.param(None, marks=pytest.mark.skip(f"the worked cases are not here: {REFERENCE.name}"))]
    return [pytest.param(case, id=case["id"]) for case in json.loads(REFERENCE.read_text())[method]]


@pytest.mark.parametrize("case", cases("rula"))
def test_rula_is_as_worked(case):
    found = rula(
        **case["input"],
        muscle_use=case["muscle_use"],
        force_kg=case["force_kg"],
        force_pattern=case["force_pattern"],
    )
    assert {name: getattr(found, name) for name in case["subscores"]} == case["subscores"]
    assert found.force == case["force_score"]
    for name in ("table_a", "table_b", "score_c", "score_d", "grand", "action_level"):
        assert getattr(found, name) == case[name], name


@pytest.mark.parametrize("case", cases("reba"))
def test_reba_is_as_worked(case):
    found = reba(**case["input"], **{name: case[name] for name in ("load_kg", "shock", "coupling", "activity")})
    assert {name: getattr(found, name) for name in case["subscores"]} == case["subscores"]
    for name in ("table_a", "table_b", "score_a", "score_b", "score_c", "reba", "action_level"):
        assert getattr(found, name) == case[name], name


@pytest.mark.parametrize("case", cases("owas"))
def test_owas_is_as_worked(case):
    assert owas(case["code"]).category == case["action_category"]


def measured(case, options=USUAL):
    """(COLUMNS,) of a skeleton, and what is said of it: sitting where its note says so, nothing carried."""
    names = [name.replace("l_", "left_").replace("r_", "right_") for name in case["joints_m"]]
    row = measures_of_positions(np.array(list(case["joints_m"].values())), names, options)
    return row, Bounds(sitting=(1, 1)) if case["note"].startswith("seated") else NOTHING_OPEN


@pytest.mark.parametrize("case", cases("skeleton"))
def test_a_skeleton_scores_as_worked(case):
    row, said = measured(case)
    found = score(row[None], said)
    assert found.rula[0].tolist() == [case["rula_worst"]] * 2
    assert found.reba[0].tolist() == [case["reba_worst"]] * 2
    assert found.owas[0].tolist() == [case["owas_action_category"]] * 2


@pytest.mark.parametrize("case", cases("skeleton"))
def test_a_skeleton_has_the_sub_scores_that_were_worked(case):
    row, said = measured(case)
    found = explain(row, said)
    for method in ("rula", "reba"):
        expected = case[found[method]["side"]][f"{method}_subscores"]
        assert {name: found[method]["parts"][name] for name in expected} == {
            name: (n, n) for name, n in expected.items()
        }
    digits = found["owas"]["parts"]
    assert "".join(str(*digits[name]) for name in ("back", "arms", "legs", "load")) == case["owas_code"]


def test_the_fork_of_arm_reference_tells_on_a_made_stoop_too():
    stoop = moved(bent(70.0), turn([0, 1, 0], -10), "neck", ["head"])
    for side in ("left", "right"):
        stoop = arm(stoop, side, turn([0, 1, 0], -70))
    found = {
        reference: score(measures_of_positions(stoop, CANONICAL, one)[None], NOTHING_OPEN, one).rula[0].tolist()
        for reference in ("trunk", "gravity")
        for one in [Options(arm_reference=reference)]
    }
    assert found == {"trunk": [6, 6], "gravity": [5, 5]}  # as skeleton 4, below


@pytest.mark.parametrize("case", [one for one in cases("skeleton") if one.values[0] is None or one.id == "skel04"])
def test_a_stoop_with_hanging_arms_scores_6_against_the_trunk_and_5_against_gravity(case):
    scores = [score(measured(case, options)[0][None], NOTHING_OPEN, options).rula[0].tolist()
              for options in (Options(), Options(arm_reference="gravity"))]  # fmt: skip
    # against the trunk the arms are flexed by 70: upper arm 3: table A "34" 3; against gravity 0: 1, "22" 2;
    # neck 4 (10 degrees back), trunk 4: table B 7; table C (3, 7) 6, (2, 7) 5
    assert scores == [[6, 6], [5, 5]]

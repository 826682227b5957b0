from dataclasses import fields

import pytest

from opsim.ergonomics.scores.scoring import EITHER, NOTHING_OPEN, WALKING, bounds_of
from opsim.plan.tasks import Handling

SAID = Handling(8.0, "fair", "repeated", "end", True, True, "unbalanced", True)


def test_what_is_said_leaves_nothing_open():
    # 8 kg repeated: RULA 2; REBA 1; OWAS 1; fair grip 1
    found = bounds_of(SAID)
    assert (found.rula_force, found.reba_load, found.owas_load, found.coupling) == ((2, 2), (1, 1), (1, 1), (1, 1))
    assert (found.wrist_twist, found.supported, found.sitting, found.one_legged, found.rapid) == ((2, 2), *[(1, 1)] * 4)


def test_what_is_not_said_is_all_that_it_may_be():
    found = bounds_of(Handling())
    assert (found.rula_force, found.reba_load, found.owas_load, found.coupling) == ((0, 3), (0, 3), (1, 3), (0, 3))
    assert found.wrist_twist == (1, 2)
    assert (found.supported, found.sitting, found.one_legged, found.rapid) == (EITHER,) * 4


@pytest.mark.parametrize(
    ("load_kg", "force", "rula", "worksheet", "reba", "owas"),
    [
        (8.0, None, (1, 3), (1, 3), (1, 2), (1, 1)),
        (12.0, None, (2, 3), (3, 3), (2, 3), (2, 2)),
        (12.0, "intermittent", (2, 2), (3, 3), (2, 2), (2, 2)),
        (None, "intermittent", (0, 2), (0, 3), (0, 2), (1, 3)),
        (None, "shock", (3, 3), (3, 3), (1, 3), (1, 3)),
        (1.0, None, (0, 3), (0, 3), (0, 1), (1, 1)),
        (0.0, None, (0, 0), (0, 0), (0, 0), (1, 1)),
        (0.0, "shock", (3, 3), (3, 3), (1, 1), (1, 1)),
    ],
)
def test_load_and_force_together_make_the_range(load_kg, force, rula, worksheet, reba, owas):
    found = bounds_of(Handling(load_kg=load_kg, force=force))
    assert (found.rula_force, found.rula_force_worksheet, found.reba_load, found.owas_load) == (
        rula,
        worksheet,
        reba,
        owas,
    )


def test_a_load_of_nothing_needs_no_grip_but_one_that_is_named_counts():
    assert bounds_of(Handling(load_kg=0.0)).coupling == (0, 0)
    assert bounds_of(Handling(load_kg=0.0, grip="poor")).coupling == (2, 2)


def test_empty_hands_have_no_load_force_or_grip_and_all_else_as_before():
    found, whole = bounds_of(SAID).empty_handed(), bounds_of(SAID)
    held = {
        "rula_force": (0, 0),
        "rula_force_worksheet": (0, 0),
        "reba_load": (0, 0),
        "owas_load": (1, 1),
        "coupling": (0, 0),
    }
    assert {one.name: getattr(found, one.name) for one in fields(found)} == {
        one.name: held.get(one.name, getattr(whole, one.name)) for one in fields(found)
    }


def test_who_walks_stands_on_both_feet_whatever_he_carries():
    assert WALKING.walking and WALKING.one_legged == WALKING.sitting == WALKING.supported == (0, 0)
    assert WALKING.reba_load == (0, 3) and not NOTHING_OPEN.walking
    assert bounds_of(SAID, walking=True).reba_load == (1, 1)

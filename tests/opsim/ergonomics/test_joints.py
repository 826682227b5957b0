import emulator.skeleton
from opsim.ergonomics.angles import CANONICAL, SIDES


def test_the_canonical_names_are_those_of_the_emulator():
    assert CANONICAL == emulator.skeleton.CANONICAL


def test_every_joint_of_a_limb_has_its_other_side():
    limbs = [name for name in CANONICAL if "_" in name]
    assert all(f"{side}_{name.partition('_')[2]}" in CANONICAL for name in limbs for side in SIDES)

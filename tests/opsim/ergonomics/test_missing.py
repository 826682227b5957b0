from opsim.ergonomics.angles import CANONICAL
from opsim.ergonomics.measures import missing_scores


def without(*words):
    return missing_scores([name for name in CANONICAL if not name.endswith(words)])


def test_the_canonical_joints_miss_nothing_that_is_scored():
    assert missing_scores(CANONICAL) == [] and without("spine", "chest") == []


def test_without_hands_the_wrist_is_not_known_and_stands_for_them():
    (said,) = without("hand")
    assert said.startswith("no hands: how far the wrist is bent is not known, so RULA and REBA are wider by it")
    assert "OWAS does not ask" in said and "those of the wrist" in said


def test_without_wrists_and_head_three_things_are_not_known():
    head, wrists = without("wrist", "hand", "head")
    assert head.startswith("no head: the neck is not known") and wrists.startswith(
        "no wrists or hands: how far elbow and wrist"
    )


def test_whatever_a_missing_joint_hides_is_named():
    """Without hips thighs have no upper end; without a shoulder the neck has no frame."""
    assert without("hip")[0].startswith("no hips: how far trunk and knees are bent")
    assert without("left_shoulder")[0].startswith("no left shoulder: twist of the trunk, neck and upper arms")


def test_one_side_is_named():
    assert missing_scores([name for name in CANONICAL if name != "left_knee"])[0].startswith("no left knee: ")


def test_a_skeleton_of_nothing_says_so_of_every_score():
    trunk, shoulders, head, elbows, wrists, legs, feet = missing_scores(())
    assert trunk.startswith("no pelvis, neck or hips: ") and "RULA, REBA and OWAS" in trunk
    assert (
        shoulders.startswith("no shoulders")
        and elbows.startswith("no elbows")
        and legs.startswith("no knees or ankles")
    )
    assert head.startswith("no head") and wrists.startswith("no wrists") and feet.startswith("no ankles")


def test_without_toes_the_floor_is_an_ankle_and_without_ankles_no_lift_is_seen():
    (toes,), (legs, ankles) = without("toe"), without("ankle", "toe")
    assert toes.startswith("no toes: the floor is taken where the lower ankle is")
    assert legs.startswith("no ankles: how far knees") and "no lift is seen" in ankles

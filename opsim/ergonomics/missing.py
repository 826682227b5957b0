"""What a skeleton does not tell, as sentences: which scores remain, and which become wider."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from opsim.ergonomics.joints import CANONICAL, SIDES

TRUNK = ("pelvis", "neck", "left_hip", "right_hip")
SHOULDERS = ("left_shoulder", "right_shoulder")


def missing_scores(names: Sequence[str]) -> list[str]:
    """Sentences, none where a skeleton of joints ``names`` has all that RULA, REBA and OWAS look at.

    A sub-score that cannot be seen counts as anything from its lowest to its highest; what none can be made of is said.
    """
    gone = [joint for joint in CANONICAL if joint not in names]
    return list(_sentences(set(gone)))


def _sentences(gone: set[str]) -> Iterator[str]:
    all_scores = "RULA, REBA and OWAS"
    trunk = _listed(gone, TRUNK)
    if trunk:
        bent = "trunk and knees are" if gone & {"left_hip", "right_hip"} else "the trunk is"
        yield f"no {trunk}: how far {bent} bent is not known, and {all_scores} are wider by all that it may be"
    shoulders = _listed(gone, SHOULDERS)
    if shoulders:
        yield f"no {shoulders}: twist of the trunk, neck and upper arms are not known: {all_scores} are wider by all"
    if "head" in gone:
        yield "no head: the neck is not known, so RULA and REBA are wider by all that it may be; OWAS does not ask"
    yield from _arm(gone)
    legs = _listed(gone, tuple(f"{side}_{joint}" for joint in ("knee", "ankle") for side in SIDES))
    if legs:
        yield f"no {legs}: how far knees are bent is not known, so REBA and OWAS are wider; RULA does not ask"
    yield from _feet(gone)


def _feet(gone: set[str]) -> Iterator[str]:
    """What heights and reaches of the hands are made of; no score asks for them, NIOSH and Garg do."""
    ankles, toes = (_listed(gone, _both(joint)) for joint in ("ankle", "toe"))
    if ankles:
        yield (
            f"no {ankles}: how far the hands are from them is not known, so no lift is seen: there is no lifting "
            "index, and energy has none of it"
        )
    elif toes == "toes":
        yield (
            "no toes: the floor is taken where the lower ankle is, so in lifts and bends hands are lower than they "
            "are, by the height of an ankle; RULA, REBA and OWAS do not ask"
        )


def _arm(gone: set[str]) -> Iterator[str]:
    elbows, wrists, hands = (_listed(gone, _both(joint)) for joint in ("elbow", "wrist", "hand"))
    if elbows:
        yield f"no {elbows}: upper arm and elbow are not known, so RULA, REBA and OWAS are wider by both"
    if wrists:
        both = _listed(gone, (*_both("wrist"), *_both("hand")))
        yield (
            f"no {both}: how far elbow and wrist are bent is not known, so RULA and REBA are wider by both; OWAS "
            "does not ask"
        )
    elif hands:
        yield (
            f"no {hands}: how far the wrist is bent is not known, so RULA and REBA are wider by it; OWAS does not ask. "
            "Heights and reaches are those of the wrist"
        )


def _both(joint: str) -> tuple[str, ...]:
    return tuple(f"{side}_{joint}" for side in SIDES)


def _listed(gone: set[str], joints: Sequence[str]) -> str:
    """Those that are gone, in words: "wrists" where both sides are, else by name."""
    words: list[str] = []
    for joint in joints:
        other = joint.removeprefix("left_").removeprefix("right_")
        both = other != joint and set(_both(other)) <= gone
        word = f"{other}s" if both else joint.replace("_", " ")
        words += [word] if joint in gone and word not in words else []
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} or {words[-1]}" if words else ""

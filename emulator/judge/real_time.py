"""Drawn movements beside recorded ones in real time: speeds, jerk, feet, balance, bones, angles, and a classifier.

A posture can be right in every frame and the movement still impossible. All figures are of the movement in its own
seconds, recorded and drawn read alike (``clips``); ``sentence`` says in words what draws are good for.
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from emulator.judge.clips import Clips
from emulator.judge.feet import feet, footing, standing_m, unsupported
from emulator.judge.joint_limits import joint_angles_deg
from emulator.judge.joint_speeds import energies, median_speed_ratio, peak_ratio, peaks, share_too_fast
from emulator.judge.kinematic_test import FEWEST, kinematic_test

NONE = float("nan")
EDGE = 0.001
"""An angle is within the recorded range between these quantiles from either end."""
N_PERMUTATIONS = 39
MOST_ENERGY, MOST_FAST, MOST_JERK, MOST_AUC = 1.2, 0.02, 1.3, 0.75
SPEED_OFF, SLIDE_OFF, MORE_SUNK_MM, MORE_UNSUPPORTED = 0.1, 0.2, 5.0, 0.03
"""How far draws may be from recordings for ``sentence`` to call them as recorded."""


@dataclass(frozen=True)
class RealTime:
    """How n movements stand beside recordings that they are held ``against``; NaN for what cannot be said.

    too_fast           : share in which a joint is faster than 1.1 x the fastest joint recorded
    fastest_m_per_s    : greatest speed of any joint
    speed_ratio        : median of the fastest joint's peak speed, over that recorded
    acceleration_ratio, jerk_ratio : peak of a joint over that recorded, medians over movements and then joints
    places_mm, speeds_mm_per_s : energy distances (V-statistics) of places and of speeds
    planted            : share of the time with a foot down
    wander_cm, slide_cm: how far a planted foot strays from its place (90 % quantile), and its way in a stance
    sunk_mm            : how deep the deepest joint goes below where it stands in recordings
    unsupported        : share of that time with the centre of mass outside the planted feet
    bone_change        : greatest change of a bone's length within a movement, as a share of its length
    beyond_deg         : farthest that a joint angle goes beyond the recorded range; outside : share of frames beyond
    auc, auc_p         : of the kinematic two-sample test; .5 cannot be told from the recordings, 1 always can
    telling            : what tells most, in words
    notes              : what could not be measured, and why
    """

    n: int
    n_against: int
    too_fast: float
    fastest_m_per_s: float
    speed_ratio: float
    acceleration_ratio: float
    jerk_ratio: float
    places_mm: float
    speeds_mm_per_s: float
    planted: float = NONE
    wander_cm: float = NONE
    slide_cm: float = NONE
    sunk_mm: float = NONE
    unsupported: float = NONE
    bone_change: float = NONE
    beyond_deg: float = NONE
    outside: float = NONE
    auc: float = NONE
    auc_p: float = NONE
    telling: str = ""
    notes: tuple[str, ...] = ()

    @property
    def figures(self) -> dict[str, float]:
        """The numbers alone."""
        return {f.name: float(getattr(self, f.name)) for f in fields(self) if f.type in ("int", "float")}


def real_time(
    clips: Clips, against: Clips, rng: np.random.Generator | None = None, n_permutations: int = N_PERMUTATIONS
) -> RealTime:
    """Measure clips, drawn or recorded, against recordings. rng: deals the test's folds; None: without the test.

    Raises ValueError for clips of another skeleton.
    """
    if clips.skeleton != against.skeleton:
        raise ValueError("real time: the movements have another skeleton than the recordings")
    notes: list[str] = []
    places_mm, speeds_mm_per_s = energies(clips, against)
    found: dict[str, float | str] = {"bone_change": bone_change(clips)}
    if feet(clips.skeleton):
        down = footing(clips, standing_m(against))
        found |= {name: _mean(getattr(down, name)) for name in ("planted", "wander_cm", "slide_cm", "sunk_mm")}
        if not down.planted.any():
            notes.append("feet: none is ever planted")
    else:
        notes.append("feet: the skeleton has none, so nothing is said of slide and support")
    for part, measure in (("balance", _balance), ("angles", _angles), ("test", _test)):
        if part == "test" and rng is None:
            continue
        try:
            found |= measure(clips, against, rng, n_permutations)
        except ValueError as error:
            notes.append(f"{part}: {error}")
    return RealTime(
        len(clips),
        len(against),
        share_too_fast(clips, against),
        float(peaks(clips, 1).max()),
        median_speed_ratio(clips, against),
        peak_ratio(clips, against, 2),
        peak_ratio(clips, against, 3),
        places_mm,
        speeds_mm_per_s,
        notes=tuple(notes),
        **found,  # type: ignore[arg-type]
    )


def bone_change(clips: Clips) -> float:
    """Greatest difference of a bone's length from its median in the clip, as a share of that; 0 for rigid bones."""
    worst = 0.0
    for positions in clips.positions_m:
        length = clips.skeleton.bone_lengths(positions)
        usual = np.median(length, axis=0)
        worst = max(worst, float((np.abs(length - usual) / np.maximum(usual, 1e-9)).max()))
    return worst


def beyond_range(clips: Clips, against: Clips) -> tuple[float, float]:
    """Degrees beyond the recorded range of the joint angles at the farthest, and the share of frames beyond any.

    Raises ValueError for a skeleton without the joints that ``joint_angles_deg`` needs.
    """
    recorded = [joint_angles_deg(against.skeleton, p) for p in against.positions_m]
    drawn = [joint_angles_deg(clips.skeleton, p) for p in clips.positions_m]
    beyond = np.zeros(sum(len(p) for p in clips.positions_m))
    for name in recorded[0]:
        theirs, ours = (np.concatenate([one[name] for one in some]) for some in (recorded, drawn))
        if np.isnan(theirs).all():
            continue
        low, high = np.nanquantile(theirs, (EDGE, 1 - EDGE))
        excess = np.nan_to_num(np.maximum(low - ours, ours - high), nan=0.0).max(axis=-1)
        beyond = np.maximum(beyond, excess)
    return float(beyond.max()), float(np.mean(beyond > 0))


def sentence(drawn: RealTime, recorded: RealTime) -> str:
    """What draws are good for and what not, in a sentence with figures.

    recorded : of other recordings of the same people, held against the same ones as the draws
    """
    found = _verdicts(drawn, recorded)
    good, bad = ([words for fine, words in found if bool(fine) is kind] for kind in (True, False))
    parts = [f"draws are as recorded in {_listed(good)}"] if good else []
    if bad:
        parts.append(f"{'they' if good else 'draws'} are not as recorded in {_listed(bad)}")
    return "; ".join(parts) + _told_apart(drawn)


def _verdicts(drawn: RealTime, recorded: RealTime) -> list[tuple[bool, str]]:
    """(as recorded, words) of each figure that both have."""
    energy = f"energy {drawn.places_mm:.0f} mm, recordings {recorded.places_mm:.0f}"
    found = [(drawn.places_mm <= MOST_ENERGY * recorded.places_mm, f"places ({energy})")]
    if np.isfinite(drawn.speed_ratio):
        fine = drawn.too_fast <= max(MOST_FAST, recorded.too_fast) and abs(drawn.speed_ratio - 1) <= SPEED_OFF
        fast = f"{_percent(drawn.too_fast)} of draws with a joint over 1.1 x the fastest recorded"
        found.append((fine, f"speed ({fast}, median peak {drawn.speed_ratio:.2f} x)"))
    if np.isfinite(drawn.jerk_ratio):
        found.append((drawn.jerk_ratio <= MOST_JERK, f"smoothness (peak jerk {drawn.jerk_ratio:.1f} x)"))
    if np.isfinite([drawn.slide_cm, recorded.slide_cm]).all():
        near = abs(drawn.slide_cm - recorded.slide_cm) <= SLIDE_OFF * recorded.slide_cm
        deep = drawn.sunk_mm > recorded.sunk_mm + MORE_SUNK_MM
        sunk = f", {drawn.sunk_mm:.0f} mm into the floor, recorded {recorded.sunk_mm:.0f}" if deep else ""
        words = f"feet (slide {drawn.slide_cm:.1f} cm a stance, recorded {recorded.slide_cm:.1f}{sunk})"
        found.append((near and not deep, words))
    if np.isfinite([drawn.unsupported, recorded.unsupported]).all():
        fine = drawn.unsupported <= recorded.unsupported + MORE_UNSUPPORTED
        beside = f"{_percent(drawn.unsupported)} of the time off the feet, recorded {_percent(recorded.unsupported)}"
        found.append((fine, f"balance ({beside})"))
    return found


def _told_apart(drawn: RealTime) -> str:
    if np.isnan(drawn.auc):
        return ""
    if drawn.auc <= 0.6:
        return f"; a classifier cannot tell them from recordings (area under the curve {drawn.auc:.2f})"
    how = "often" if drawn.auc <= MOST_AUC else "nearly always" if drawn.auc > 0.9 else "mostly"
    return f"; a classifier {how} tells them from recordings ({drawn.auc:.2f}), most by {drawn.telling}"


def _listed(words: list[str]) -> str:
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} and {words[-1]}"


def _percent(share: float) -> str:
    return f"{100 * share:.0f} %"


def _balance(clips: Clips, *_: object) -> dict[str, float | str]:
    return {"unsupported": _mean(unsupported(clips))} if feet(clips.skeleton) else {}


def _angles(clips: Clips, against: Clips, *_: object) -> dict[str, float | str]:
    return dict(zip(("beyond_deg", "outside"), beyond_range(clips, against)))


def _test(clips: Clips, against: Clips, rng: np.random.Generator | None, n_permutations: int) -> dict[str, float | str]:
    assert rng is not None
    if min(len(clips), len(against)) < FEWEST:
        raise ValueError(f"found {len(clips)} and {len(against)} movements, expected {FEWEST} or more of each")
    found = kinematic_test(against, clips, rng, n_permutations=n_permutations)
    return {"auc": found.auc, "auc_p": found.p, "telling": found.telling[0]}


def _mean(values: np.ndarray) -> float:
    known = values[np.isfinite(values)]
    return float(known.mean()) if len(known) else NONE

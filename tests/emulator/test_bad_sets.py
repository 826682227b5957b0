"""What recordings can be wrong in: each gives a clear error, or a named fallback that the fit report notes."""

import re
from dataclasses import replace

import numpy as np
import pytest

from emulator.geometry import sphere
from emulator.geometry import warps as warp
from emulator.geometry.alignment import align
from emulator.model.emulator import SCHEMES, MotionEmulator
from emulator.motion import motion_from_positions
from emulator.skeleton import Skeleton
from emulator.synthetic.tasks import make
from tests.made import made_sequences
from tests.opsim.cli.calls import one_person, opsim

LIFTS = make("lift", 3, 4, seed=2)[0]
ODD = 2  # w1/r3
GAUSSIAN = {"scheme": SCHEMES[-1], "n_times": 41, "n_knots": 12}
"""Fitted in a fifth of the time: what is mended or noted comes before densities."""


def one(change):
    """The lifts with one of them changed."""
    return replace(LIFTS, motions=tuple(change(m) if i == ODD else m for i, m in enumerate(LIFTS.motions)))


def every(change):
    return replace(LIFTS, motions=tuple(change(m) for m in LIFTS.motions))


def put(name, at, value):
    def change(motion):
        values = np.array(getattr(motion, name), float)
        values[at] = value
        return replace(motion, **{name: values})

    return change


def turned(frames, bones):
    return lambda m: put("directions", (frames, bones), -m.directions[frames, bones])(m)


def still(motion):
    frames = np.zeros(len(motion.time_s), int)
    return replace(
        motion, directions=motion.directions[frames], root_m=motion.root_m[frames], yaw_rad=motion.yaw_rad[frames]
    )


def frozen_ends(motion):
    n = len(motion.time_s)
    frames = np.clip(np.arange(n), n // 5, n - n // 5)
    return replace(
        motion, directions=motion.directions[frames], root_m=motion.root_m[frames], yaw_rad=motion.yaw_rad[frames]
    )


def first_and_last(motion):
    ends = [0, -1]
    return replace(
        motion,
        directions=motion.directions[ends],
        time_s=motion.time_s[ends],
        root_m=motion.root_m[ends],
        yaw_rad=motion.yaw_rad[ends],
        stretch=None,
    )


ALL, SHOULDER = slice(None), 8
UP = put("directions", (slice(30, 33), SHOULDER), [0, 0, 1.0])
REFUSED = {
    "a direction that is no number": (one(put("directions", (3, 2, 0), np.nan)), "w1/r3: the direction of neck is no"),
    "a direction of another length": (one(put("directions", (5, 2), 0.7)), "w1/r3: the direction of neck at frame 5"),
    "a root that is no number": (one(put("root_m", (3, 2), np.inf)), "w1/r3: root_m is no number at frame 3"),
    "a heading that is no number": (one(put("yaw_rad", 4, np.nan)), "w1/r3: yaw_rad is no number at frame 4"),
    "a bone without a length": (one(put("bone_length_m", 3, 0.0)), "w1/r3: the bone to head has length 0 m"),
    "a mark that is no number": (one(put("mark_s", 0, np.nan)), "w1/r3: mark grasp at nan s, expected 0 to"),
    "a mark after the end": (one(put("mark_s", 1, 99.0)), "w1/r3: mark set_down at 99 s, expected 0 to"),
    "marks out of order": (one(lambda m: replace(m, mark_s=m.mark_s[::-1])), "w1/r3: marks grasp, set_down .*order"),
    "two frames": (one(first_and_last), "w1/r3: found 2 frames, expected 4 or more"),
    "a bone that turns about each frame": (
        one(turned(slice(None, None, 2), SHOULDER)), r"w1/r3: the bone to right_shoulder turns about .* \d+ times more"
    ),
    "one repetition": (LIFTS.subset([0]), "at least 3 repetitions, found 1"),
    "two repetitions": (LIFTS.subset([0, 1]), "at least 3 repetitions, found 2"),
}  # fmt: skip
NOTED = {
    "a bone that turns about": (
        one(turned(slice(40, None), SHOULDER)),
        r"w1/r3: the bone to right_shoulder turns about between frames 39 and 40 \(at .* s\); led over .*swapped",
    ),
    "a first frame turned about": (
        one(turned(0, SHOULDER)), r"w1/r3: .* right_shoulder turns about .* 0 and 1 \(at .* s\); left to the frames"
    ),
    "last frames turned about": (
        one(turned(slice(-3, None), SHOULDER)), r"w1/r3: .* right_shoulder turns about .*; left to the frames beside"
    ),
    "a bone the other way round": (
        one(turned(ALL, 4)), r"the bone to left_shoulder points opposite to .* in w1/r3 at .* to .* s; another base"
    ),
    "postures all the other way": (
        one(turned(ALL, ALL)), r"the bones to spine, .* and 14 more point opposite to .* in w1/r3 at .*another base"
    ),
    "a constant repetition": (one(still), "1 of 12 repetitions do not move, their own clock is kept: w1/r3"),
    "nothing but standing": (every(still), "12 of 12 repetitions do not move"),
    "frozen ends": (every(frozen_ends), "are cut out and modelled as dwell times"),
    "frozen ends of one": (one(frozen_ends), "in 1 of 12 repetitions"),
    "a jump of a marker": (one(UP), "w1/r3: right_shoulder jumps by .* rad at frames 30 to 32; bridged"),
    "a frame upside down": (one(turned(10, ALL)), "w1/r3: spine jumps by .*and 14 more; bridged"),
    "a jump of the root": (one(put("root_m", 20, 3.0)), "w1/r3: root_m jumps by .* m at frame 20"),
    "uneven frames": (one(lambda m: replace(m, time_s=m.time_s**1.2)), "w1/r3: its frames are uneven in time"),
    "a recording twice": (LIFTS.subset([*range(12), 0]), "copies of one recording, all used: w1/r1 of w1/r1"),
    "all one recording": (LIFTS.subset([0] * 6), "one and the same movement"),
    "each twice": (LIFTS.subset([*range(6), *range(6)]), "half of the repetitions or more are copies"),
}  # fmt: skip


@pytest.mark.parametrize("case", REFUSED)
def test_what_no_model_can_be_fitted_to_is_refused_by_the_name_of_the_repetition(case):
    motions, words = REFUSED[case]
    with pytest.raises(ValueError, match=words):
        MotionEmulator.fit(motions)


STILL = ("a constant repetition", "nothing but standing", "all one recording")
"""Where nothing varies, or hardly anything: the usual density has to stand this, too."""


@pytest.mark.parametrize(
    ("case", "settings"),
    [
        *(pytest.param(case, GAUSSIAN, id=case) for case in NOTED),
        *(
            pytest.param(case, {}, id=f"{case}, usual density", marks=() if case in STILL else pytest.mark.slow)
            for case in NOTED
        ),
    ],
)
def test_what_is_mended_or_odd_is_noted_and_the_model_draws(case, settings):
    motions, words = NOTED[case]
    emulator = MotionEmulator.fit(motions, **settings)
    assert any(re.search(words, note) for note in emulator.report.notes), emulator.report.notes
    drawn = emulator.sample(20, np.random.default_rng(0))
    assert np.all(np.isfinite(drawn.positions_m(n_times=7))) and np.all(drawn.duration_s > 0)
    assert np.all(np.isfinite(drawn.mark_s))


@pytest.fixture(scope="module")
def sound():
    return MotionEmulator.fit(LIFTS, **GAUSSIAN)


def test_a_sound_set_has_no_notes(sound):
    assert sound.report.notes == ()


def test_all_mistakes_are_named_at_once():
    wrong = every(put("mark_s", 1, 99.0))
    wrong = replace(wrong, motions=(put("yaw_rad", 0, np.nan)(wrong.motions[0]), *wrong.motions[1:]))
    with pytest.raises(ValueError) as error:
        MotionEmulator.fit(wrong)
    lines = str(error.value).splitlines()
    assert len(lines) == 11 and "yaw_rad" in lines[0] and lines[-1] == "lift: and 3 more"


@pytest.mark.parametrize(("n_bones", "n_frames"), [(1, 3), (8, 3), (20, 3), (3, 25)])
def test_a_glitch_that_is_not_mended_bends_no_other_warp_and_its_own_by_little(n_bones, n_frames):
    sequences, warps, _ = made_sequences(20, 101, seed=2)
    truth = warp.centre(warp.invert(warps))
    clean = np.abs(align(list(sequences)).warps - truth) * 100
    away = sphere.normalise(np.random.default_rng(n_bones).normal(size=(n_bones, 3)))
    spoiled = sequences.copy()
    spoiled[4, 40 : 40 + n_frames, :n_bones] = sphere.normalise(spoiled[4, 40 : 40 + n_frames, :n_bones] + 1.5 * away)
    error = np.abs(align(list(spoiled)).warps - truth) * 100
    others = np.arange(20) != 4
    assert np.abs(error[others].mean() - clean[others].mean()) < 0.05
    assert error[others].max() < clean.max() + 0.5
    assert error[4].mean() < 0.6 and error[4].max() < 4


def test_a_mended_jump_leaves_the_model_of_the_sound_recordings(sound):
    mended = MotionEmulator.fit(one(UP), **GAUSSIAN)
    apart = sphere.angle(*(m.sample(20, np.random.default_rng(0)).directions(n_times=21) for m in (sound, mended)))
    assert np.degrees(apart).mean() < 0.1


def test_a_still_repetition_among_moving_ones_does_not_bend_their_warps():
    sequences = [m.directions for m in LIFTS.motions]
    alone = align(sequences).warps
    among = align([*sequences, np.repeat(sequences[0][:1], 50, axis=0)]).warps
    assert np.abs(among[-1] - np.linspace(0, 1, 101)).max() < 0.05
    centred = warp.centre(among[:-1])
    assert np.abs(centred - warp.centre(alone)).mean() * 100 < 0.3


@pytest.fixture(scope="module")
def recording_file(tmp_path_factory):
    """Six reaches as a file of recordings; a marker of the second jumps, the third pauses, the fourth is the fifth."""
    path = tmp_path_factory.mktemp("bad") / "reach.npz"
    assert opsim("motion", "sample", "bench_work", "reach", "-n", 6, "--fps", 50, "-o", path)[0] == 0
    one_person(path)
    with np.load(path) as file:
        arrays = dict(file)
    parts = np.split(arrays["positions"], arrays["offsets"][1:-1])
    hand = arrays["names"].tolist().index("right_wrist")
    parts[1][20:22, hand, 2] += 0.2
    parts[2] = np.insert(parts[2], 30, np.repeat(parts[2][30:31], 50, axis=0), axis=0)
    parts[3] = parts[4]
    lengths = [len(part) for part in parts]
    marks = {key: np.full(6, 15) for key in arrays if key.startswith("ann_")}
    changed = {"positions": np.concatenate(parts), "offsets": np.cumsum([0, *lengths]), **marks}
    np.savez(path, **{key: value for key, value in {**arrays, **changed}.items() if key != "duration"})
    return path


def test_the_command_line_shows_every_note_and_keeps_them_in_the_library(recording_file, tmp_path):
    code, shown, _ = opsim("motion", "fit", recording_file, "-o", tmp_path / "lib.npz")
    assert code == 0
    words = " ".join(shown.split())
    notes = " ".join(MotionEmulator.load(tmp_path / "lib.npz").report.notes)
    for said in ("emulated/k1: right_wrist jumps", "copies of one recording", "in 1 of 6 repetitions"):
        assert said in notes, notes
    for said in ("jumps by", "copies of one recording", "modelled as dwell times"):
        assert said in words


def test_the_command_line_refuses_with_the_name_of_the_repetition_and_exit_code_2(recording_file, tmp_path):
    with np.load(recording_file) as file:
        arrays = dict(file)
    start, end = arrays["offsets"][4:6]
    frames = np.r_[0:start, start : start + 2, end : len(arrays["positions"])]
    offsets = arrays["offsets"].copy()
    offsets[5:] -= end - start - 2
    marks = {key: np.zeros(6, int) for key in arrays if key.startswith("ann_")}
    np.savez(tmp_path / "bad.npz", **{**arrays, "positions": arrays["positions"][frames], "offsets": offsets, **marks})
    code, _, complaint = opsim("motion", "fit", tmp_path / "bad.npz", "-o", tmp_path / "lib.npz")
    assert code == 2 and "emulated/k4: found 2 frames, expected 4 or more" in " ".join(complaint.split())
    assert not (tmp_path / "lib.npz").exists()


def test_two_skeletons_in_one_set_are_refused_with_what_differs():
    short = headless(LIFTS.motions[ODD])
    with pytest.raises(ValueError, match=r"lift: motion w1/r3 has another skeleton than w1/r1: only one has head"):
        replace(LIFTS, motions=(*LIFTS.motions[:ODD], short))


def headless(motion):
    keep = [i for i, name in enumerate(motion.skeleton.names) if name != "head"]
    parents = motion.skeleton.parents
    body = Skeleton(
        tuple(motion.skeleton.names[i] for i in keep),
        tuple(keep.index(parents[i]) if parents[i] >= 0 else -1 for i in keep),
    )
    places = motion.positions_m(world=True)[:, keep]
    return motion_from_positions(body, places, 50.0, worker="w1", trial="r3", mark_s=motion.mark_s)

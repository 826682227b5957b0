import xml.etree.ElementTree as ElementTree

import numpy as np
import pytest

from opsim.report.plot.body import Strip, chains, stage_of, view_axes
from opsim.report.sections.motions import MOST_LINES, _figure, _words, draw_strips, strips_of

NAMES = (
    *("pelvis", "spine", "chest", "neck", "head"),
    *("left_shoulder", "left_elbow", "left_wrist", "right_shoulder", "right_elbow", "right_wrist"),
    *("left_hip", "left_knee", "left_ankle", "right_hip", "right_knee", "right_ankle"),
)
PARENTS = (-1, 0, 1, 2, 3, 2, 5, 6, 2, 8, 9, 0, 11, 12, 0, 14, 15)
STANDING = np.array(
    [
        *((0, 0, 1.0), (0, 0, 1.15), (0, 0, 1.35), (0, 0, 1.5), (0, 0, 1.65)),
        *((0, 0.2, 1.45), (0, 0.25, 1.2), (0, 0.25, 0.95), (0, -0.2, 1.45), (0, -0.25, 1.2), (0, -0.25, 0.95)),
        *((0, 0.1, 0.95), (0, 0.1, 0.5), (0, 0.1, 0.08), (0, -0.1, 0.95), (0, -0.1, 0.5), (0, -0.1, 0.08)),
    ]
)


class Skeleton:
    """Enough of the emulator's skeleton: x forward, y to the left, z up."""

    names, parents = NAMES, PARENTS

    def _vectors(self, positions):
        return positions[..., 1:, :] - positions[..., list(PARENTS[1:]), :]

    def directions(self, positions):
        vectors = self._vectors(positions)
        return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)

    def bone_lengths(self, positions):
        return np.linalg.norm(self._vectors(positions), axis=-1)

    def positions(self, directions, bone_length_m, root_m):
        joints = [np.asarray(root_m)]
        for bone, parent in enumerate(PARENTS[1:]):
            joints.append(joints[parent] + bone_length_m[..., bone, None] * directions[..., bone, :])
        return np.stack(joints, axis=-2)


class Drawn:
    skeleton = Skeleton()

    def __init__(self, n, rng):
        self.duration_s = rng.uniform(1.5, 2.5, n)
        self.mark_s = self.duration_s[:, None] * 0.5

    def positions_m(self, times_s=None, n_times=101):
        lift = np.sin(np.linspace(0, np.pi, n_times))[:, None] * [0.3, 0, 0.3]
        positions = np.tile(STANDING, (len(self.duration_s), n_times, 1, 1))
        positions[:, :, NAMES.index("right_wrist")] += lift
        return positions


class Model:
    """A made TaskModel with postures: the right hand goes up and forward."""

    skeleton, mark_names = Skeleton(), ("grasp",)

    def mean_duration_s(self, worker=None):
        return 2.0

    def sample(self, n, rng, *, worker=None, condition=None):
        return Drawn(n, rng)


def moving(joint, way):
    positions = np.tile(STANDING, (11, 1, 1))
    positions[:, NAMES.index(joint)] += np.linspace(0, 1, 11)[:, None] * way
    return positions


def test_a_movement_to_the_side_is_seen_from_the_front():
    right, viewer = view_axes(moving("left_wrist", [0, 1, 0]), Skeleton())
    assert abs(right @ [0, 1]) > 0.95 and viewer @ [1, 0] > 0.95


def test_a_movement_forward_is_seen_from_the_side_with_the_face_in_sight():
    right, viewer = view_axes(moving("left_wrist", [1, 0, 0]), Skeleton())
    assert right @ [1, 0] > 0.85 and 0.3 < viewer @ [1, 0] < 0.6


def test_a_slanting_movement_is_never_seen_from_its_end_nor_from_behind():
    for way in ([1, 1, 0], [1, -1, 0], [-1, 1, 0]):
        right, viewer = view_axes(moving("right_wrist", way), Skeleton())
        assert abs(right @ np.array(way[:2]) / np.sqrt(2)) > 0.9 and viewer @ [1, 0] > 0.3


def test_the_view_turns_with_the_person():
    turned = moving("left_wrist", [1, 0, 0])[..., [1, 0, 2]] * [-1, 1, 1]  # a quarter turn to the left
    right, _ = view_axes(turned, Skeleton())
    assert right @ [0, 1] > 0.85


def test_every_bone_but_the_ties_of_the_torso_is_in_one_chain():
    drawn = [pair for line in chains(Skeleton()) for pair in zip(line[1:], line)]
    ties = {NAMES.index(f"{side}_{joint}") for side in ("left", "right") for joint in ("shoulder", "hip")}
    assert sorted(drawn) == [(j, parent) for j, parent in enumerate(PARENTS) if parent >= 0 and j not in ties]


def test_the_mean_keeps_the_length_of_bones_and_the_models_mean_duration():
    mean, *samples = strips_of(Model(), n_samples=2)
    assert mean.duration_s == 2.0 and len(samples) == 2
    assert np.allclose(mean.mark_s, [1.0])
    lengths = Skeleton().bone_lengths(samples[0].positions_m).mean(axis=0)
    assert np.allclose(Skeleton().bone_lengths(mean.positions_m), lengths)


def test_figures_stand_at_round_seconds_and_do_not_touch():
    strip = Strip("one", moving("left_wrist", [1, 0, 0]), 2.3, np.empty(0))
    stage = stage_of([strip], Skeleton(), 11)
    flat, _ = stage.flat(strip, 2.3)
    assert stage.step_s == pytest.approx(0.25)
    assert np.ptp(flat[:, 0]) < stage.m_per_s * stage.step_s


def test_the_same_arguments_give_the_same_bytes():
    assert draw_strips(Model(), n_samples=1) == draw_strips(Model(), n_samples=1)


def test_an_svg_is_xml_and_names_are_never_read_as_formulas(tmp_path):
    path = tmp_path / "x.svg"
    draw_strips(Model(), path, n_samples=1, title="<b> & $\\frac{1}$")
    assert ElementTree.parse(path).getroot().tag.endswith("svg")


def test_a_png_is_a_png(tmp_path):
    assert draw_strips(Model(), tmp_path / "x.png", n_samples=1)[:8] == b"\x89PNG\r\n\x1a\n"


def test_another_ending_is_refused(tmp_path):
    with pytest.raises(ValueError, match=r"\.png or \.svg"):
        draw_strips(Model(), tmp_path / "x.gif")


def test_a_model_without_postures_is_refused():
    class Times:
        def sample(self, n, rng, *, worker=None, condition=None):
            return type("Performances", (), {"duration_s": np.ones(n), "mark_s": np.ones((n, 0)), "skeleton": None})()

    with pytest.raises(ValueError, match="no posture"):
        draw_strips(Times())


def test_the_words_of_marks_near_each_other_take_lines_of_their_own_and_none_is_lost():
    strip = Strip("one", moving("left_wrist", [1, 0, 0]), 9.0, np.array([1.0, 1.01, 1.02, 1.03, 8.0]))
    placed = _words(strip, ("a", "b", "c", "d", "e"), 1.0, -1.0, 10.0)
    assert [word.line for word in placed] == [0, 1, 2, 3, 0]
    assert [word.words for word in placed] == ["a 1.00 s", "b 1.01 s", "c 1.02 s", "d 1.03 s", "e 8.00 s"]


def test_marks_for_whose_words_there_is_no_room_are_counted_in_the_picture():
    strip = Strip("one", moving("left_wrist", [1, 0, 0]), 9.0, np.linspace(4.0, 4.1, MOST_LINES + 3))
    said = [text.get_text() for text in _figure([strip], Skeleton(), (), "", 11, "png").axes[0].texts]
    assert "and 3 more marks, for whose words there is no room" in said


def test_the_words_of_marks_stay_out_of_the_row_below():
    strip = Strip("one", moving("left_wrist", [1, 0, 0]), 9.0, np.linspace(4.0, 4.1, MOST_LINES))
    axes = _figure([strip, strip], Skeleton(), (), "", 11, "png").axes[0]
    assert min(text.get_position()[1] for text in axes.texts) - 0.05 > axes.get_ylim()[0]

from dataclasses import asdict, fields, replace

import numpy as np
import pytest

from emulator.judge import compare, distances, plausibility, reconstruction_error, resampler, standing_deg
from emulator.judge import held_out_table as held_out_figures
from emulator.judge.held_out import COPIER, SHAKER, USUAL, Drawer, HeldOutRow, drawer
from emulator.judge.held_out_table import MEANING, MIDDLE, Figures, Unseen, figures, recorded_figures
from emulator.judge.joint_limits import Plausibility, recorded_positions_m
from emulator.judge.sequence_distances import stream
from tests.emulator.judge.halved import halves, unseen

OF_BODIES = {"outside_percent", "top_speed_m_per_s", "skate_cm"}
OF_TIMES = {"duration_p", "marks_p"}
OF_POSTURES = {"energy", "p", "novelty", "temporal_roughness", "roughness"}
OF_NUMBERS = {"error", "n_numbers"}
OF_LIKELIHOOD = {"log_likelihood", "log_likelihood_drawn"}


def told(found):
    return {name for name, value in asdict(found).items() if not np.isnan(value)}


def test_every_figure_has_a_meaning():
    assert list(MEANING) == [field.name for field in fields(Figures)] and set(MIDDLE) < set(MEANING)


@pytest.mark.parametrize(
    ("name", "has"),
    [
        (USUAL[0], OF_POSTURES | OF_NUMBERS | OF_TIMES | OF_BODIES),
        (USUAL[1], OF_POSTURES | OF_NUMBERS | OF_LIKELIHOOD),
        (COPIER, OF_POSTURES | OF_TIMES),
        (SHAKER, OF_POSTURES),
    ],
)
def test_each_drawer_has_the_figures_it_can_have_and_says_nothing_is_wrong(name, has):
    found, wrong = figures(unseen(), drawer(name, halves()))
    assert told(found) == has and wrong == []


def test_the_recordings_themselves_are_at_one_and_not_told_apart():
    found = recorded_figures(unseen())
    assert told(found) == OF_POSTURES | OF_BODIES
    assert found.energy == 1 and found.p > 0.3
    assert 0.7 < found.novelty < 1.4 and abs(found.temporal_roughness - 1) < 0.1


def test_one_who_draws_the_unseen_half_is_nearer_than_any_recording_and_as_rough():
    found, _ = figures(unseen(), Drawer("seer", lambda n, rng: resampler(halves().b, n, rng)))
    assert found.energy < 1 and found.p > 0.2 and found.novelty > 0.7
    assert abs(found.temporal_roughness - 1) < 0.1


def test_one_who_always_draws_one_posture_fails_every_judge():
    def still(n, rng):
        return np.repeat(np.repeat(halves().a[:1, :1], halves().a.shape[1], axis=1), n, axis=0)

    found, _ = figures(unseen(), Drawer("still", still))
    assert found.energy > 3 and found.p < 0.01 and found.novelty > 3 and found.temporal_roughness < 1e-6


def test_the_copier_is_seen_through_by_novelty_alone():
    found, _ = figures(unseen(), drawer(COPIER, halves()))
    assert found.novelty == 0 and found.p > 0.05 and found.energy < 1.6


def test_figures_of_postures_are_those_of_the_judges_asked_one_by_one():
    paper = drawer(USUAL[1], halves())
    rng = stream(halves().split, paper.name)
    few, many = paper.draw(12, rng), paper.draw(60, rng)
    found, _ = figures(unseen(), paper)
    expected = compare(many, few, halves().a, halves().b, rng)
    for name in ("p", "novelty", "temporal_roughness", "roughness"):
        assert getattr(found, name) == getattr(expected, name)
    assert found.log_likelihood == paper.log_likelihood(halves().b).mean()
    assert found.log_likelihood_drawn == paper.log_likelihood(few).mean()
    assert found.error == reconstruction_error(halves().b, paper.reconstruct(halves().b))


def test_of_marks_the_one_that_fits_least_is_told_and_all_are_corrected_together(monkeypatch):
    rows = [
        HeldOutRow("lift", name, 12, 12, 0.5, p, (0.0,) * 5)
        for name, p in (("duration", 0.01), ("a", 0.2), ("b", 0.04))
    ]
    monkeypatch.setattr(held_out_figures, "resampled_rows", lambda *_: rows)
    found, _ = figures(unseen(), drawer(COPIER, halves()))
    assert (found.duration_p, found.marks_p) == pytest.approx((0.03, 0.08))


def test_recorded_bodies_are_those_of_the_fitted_half():
    fitted, found = halves().fitted, recorded_figures(unseen())
    positions = recorded_positions_m(fitted)
    seen = plausibility(fitted.skeleton, positions, fitted.duration_s, standing_deg(fitted.skeleton, positions))
    assert found.top_speed_m_per_s == seen.speed_m_per_s.max() and found.skate_cm == seen.skate_cm.mean()
    assert found.outside_percent == 100 * seen.frames_outside


def test_frames_are_told_in_per_cent_speed_as_the_greatest_and_skating_as_the_mean():
    given = replace(unseen(), bodies=Plausibility({}, 0.25, {}, np.array([1.0, 3.0]), np.array([2.0, 4.0])))
    found = recorded_figures(given)
    assert (found.outside_percent, found.top_speed_m_per_s, found.skate_cm) == (25.0, 3.0, 3.0)


def test_a_scheme_that_cannot_draw_says_why_and_keeps_the_figures_it_has():
    def explodes(n, rng):
        raise ValueError("it explodes")

    paper = replace(drawer(USUAL[1], halves()), draw=explodes)
    found, wrong = figures(unseen(), paper)
    assert told(found) == OF_NUMBERS | {"log_likelihood"} and wrong == ["it explodes"]


def test_a_body_without_the_joints_of_the_limits_has_no_such_figures_and_it_is_said_why():
    skeleton = halves().fitted.skeleton
    odd = replace(skeleton, names=tuple("lump" if name == "head" else name for name in skeleton.names))
    fitted, held = (
        replace(half, motions=tuple(replace(m, skeleton=odd) for m in half.motions))
        for half in (halves().fitted, halves().held)
    )
    found = Unseen.of(replace(halves(), fitted=fitted, held=held), 20)
    assert found.bodies is None and "head" in found.why
    assert told(recorded_figures(found)) == OF_POSTURES


def test_distances_are_told_from_the_unseen_to_the_fitted():
    assert np.array_equal(unseen().to_fitted, distances(halves().a, halves().b).T)

from dataclasses import asdict, fields, replace

import numpy as np
import pytest

from emulator.judge import compare, distances, plausibility, reconstruction_error, resampler, standing_deg
from emulator.judge import held_out_table as held_out_figures
from emulator.judge.held_out import (
    COPIER,
    RECORDED,
    SHAKER,
    USUAL,
    Drawer,
    HeldOutRow,
    apportioned,
    draw_alike,
    in_halves,
    too_few,
)
from emulator.judge.held_out_table import (
    HONEST,
    MEANING,
    MIDDLE,
    Figures,
    Judged,
    Unseen,
    figures,
    judge_held_out,
    recorded_figures,
)
from emulator.judge.joint_limits import Plausibility, recorded_positions_m
from emulator.judge.sequence_distances import stream
from emulator.model.emulator import SCHEMES, MotionEmulator
from emulator.synthetic.tasks import make
from tests.emulator.fitted import made as made_halves
from tests.emulator.judge.halved import SMALL, drawn_by, halves, judged, made, unseen


def names(motions):
    return {motion.name for motion in motions.motions}


def test_everybody_is_in_both_halves_and_no_repetition_is():
    half = halves()
    assert half.fitted.workers == half.held.workers == made().workers and half.task == "lift"
    assert names(half.fitted) | names(half.held) == names(made())
    assert not names(half.fitted) & names(half.held)
    assert half.a.shape == half.b.shape == (12, 31, made().skeleton.n_bones, 3)


def test_the_number_of_the_split_decides_who_is_where():
    assert names(in_halves(made(), 3, 31).fitted) == names(halves().fitted)
    assert names(in_halves(made(), 4, 31).fitted) != names(halves().fitted)


def test_the_fitted_half_is_aligned_as_an_emulator_aligns_it():
    """Else drawn and unseen postures would stand on two clocks."""
    emulator = MotionEmulator.fit(halves().fitted, n_times=31, scheme=SCHEMES[-1])
    centre = emulator.flatten.inverse(emulator.posture.mean.reshape(1, 31, -1))
    assert np.allclose(emulator.flatten.forward(halves().a).mean(axis=0).ravel(), emulator.posture.mean, atol=1e-3)
    assert centre.shape[1:] == halves().a.shape[1:]


def test_the_unseen_half_comes_closer_by_its_warps():
    """The spread about the fitted half's course, against that of the same repetitions in their own time."""
    from emulator.geometry.alignment import resample

    course = halves().a.mean(axis=0)
    plain = np.stack([resample(m.directions, np.linspace(0, 1, 31)) for m in halves().held.motions])
    aligned, unaligned = (np.mean((x - course) ** 2) for x in (halves().b, plain))
    assert aligned < 0.7 * unaligned


def test_people_with_one_repetition_hold_nothing_out():
    assert too_few(made()) == []
    (words,) = too_few(make("reach", 13, 1)[0])
    assert words == (
        "reach: 13 repetitions of 13 people leave 0 to judge by (of each person every second); "
        "expected 5 or more: record people more than once"
    )


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
    found, wrong = figures(unseen(), drawn_by(name))
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
    found, _ = figures(unseen(), drawn_by(COPIER))
    assert found.novelty == 0 and found.p > 0.05 and found.energy < 1.6


def test_figures_of_postures_are_those_of_the_judges_asked_one_by_one():
    paper = drawn_by(USUAL[1])
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
    found, _ = figures(unseen(), drawn_by(COPIER))
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

    paper = replace(drawn_by(USUAL[1]), draw=explodes)
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


def of(*novelties):
    """What was found of a copier in some splits, beside recordings that are as they should be."""
    splits = [
        {RECORDED: Figures(novelty=1.0), COPIER: Figures(novelty=n), SHAKER: Figures(novelty=n)} for n in novelties
    ]
    return Judged("lift", tuple(splits), ())


def test_recordings_come_first_and_both_controls_last():
    assert list(judged().rows) == [RECORDED, *USUAL, COPIER, SHAKER]
    assert len(judged().splits) == 1 and judged().notes == ()


def test_both_controls_fail_novelty_and_the_recordings_do_not():
    assert judged().passing_controls == []
    assert max(judged().rows[name].novelty for name in (COPIER, SHAKER)) < HONEST
    assert judged().rows[RECORDED].novelty > HONEST


def test_a_control_that_is_not_seen_through_is_named():
    assert of(0.1, 0.3).passing_controls == []
    assert of(0.7, 1.0).passing_controls == [COPIER, SHAKER]
    assert of(np.nan).passing_controls == [COPIER, SHAKER]


def test_figures_are_means_over_splits_that_have_them_and_p_values_the_middle():
    splits = tuple({"x": Figures(energy=e, p=p)} for e, p in ((1.0, 0.1), (3.0, 0.2), (np.nan, 0.9)))
    found = Judged("lift", splits, ()).rows["x"]
    assert (found.energy, found.p) == (2.0, 0.2) and np.isnan(found.skate_cm)


def test_a_schemes_figures_do_not_depend_on_the_other_schemes_and_the_same_seed_gives_the_same():
    alone = judge_held_out(made(), [USUAL[1]], 1, **SMALL)
    one, other = (asdict(found) for found in (alone.rows[USUAL[1]], judged().splits[0][USUAL[1]]))
    assert np.array_equal(list(one.values()), list(other.values()), equal_nan=True)


def test_another_seed_has_other_halves():
    other = judge_held_out(made(), [], 1, seed=1, **SMALL)
    assert list(other.rows) == [RECORDED, COPIER, SHAKER]
    assert other.rows[RECORDED].p != judged().splits[0][RECORDED].p


def test_a_scheme_that_explodes_has_a_note_in_place_of_its_draws():
    """On 31 points, twelve of them lags, the rule that fits lifts best is one that grows."""
    name = "SIEM/SpatialPCA/VAR-pooled"
    found = judge_held_out(made(), [name, "PWI"], 1, **SMALL)
    (note,) = found.notes
    assert note.startswith(f"{name}: missing: VAR(12): its companion modulus is ") and "explode" in note
    assert np.isnan(found.rows[name].energy) and found.rows[name].error > 0
    assert not np.isnan(found.rows["PWI"].energy)


def test_notes_tell_in_how_many_splits(monkeypatch):
    from emulator.judge import held_out_table

    def refuses(name, halves):
        if halves.split == 1:
            raise ValueError("two bones are opposite")
        return real(name, halves)

    real = held_out_table.drawer
    monkeypatch.setattr(held_out_table, "drawer", refuses)
    found = judge_held_out(made(), ["PWI"], 2, **SMALL)
    assert len(found.splits) == 2 and found.notes[0] == "PWI: in 1 of 2 splits: two bones are opposite"
    assert not np.isnan(found.rows["PWI"].energy)


def test_progress_counts_to_its_total():
    heard = []
    judge_held_out(made(), [], 2, progress=lambda *said: heard.append(said), **SMALL)
    assert heard == [(n, 6, "lift") for n in range(1, 7)]


def test_all_that_is_wrong_is_said_before_anything_is_done():
    motions = make("reach", 12, 1)[0]
    broken = replace(motions.motions[3], root_m=motions.motions[3].root_m * np.nan)
    motions = replace(motions, motions=(*motions.motions[:3], broken, *motions.motions[4:]))
    with pytest.raises(ValueError) as refused:
        judge_held_out(motions, ["PWJ", "SIEM/JointPCA/MGV"])
    lines = str(refused.value).splitlines()
    assert len(lines) == 4 and "root_m is no number" in lines[-1] and "leave 0 to judge by" in lines[-2]


def test_shares_are_whole_and_in_proportion():
    assert apportioned(np.array([7, 7, 6]), 20).tolist() == [7, 7, 6]
    assert apportioned(np.array([7, 7, 6]), 1000).tolist() == [350, 350, 300]
    assert apportioned(np.array([1, 1, 1]), 5).tolist() == [2, 2, 1]


def test_each_worker_is_drawn_as_often_as_recorded():
    motions, emulator = made_halves("lift")
    drawn = draw_alike(emulator, motions, 50, np.random.default_rng(0))
    by_one = emulator.sample(10, np.random.default_rng(0), worker=motions.workers[0])
    assert len(drawn) == 50
    assert np.allclose(drawn.scores[:10], by_one.scores)


def test_a_stranger_cannot_be_drawn():
    motions, emulator = made_halves("lift")
    strangers = replace(motions, motions=tuple(replace(m, worker="nobody") for m in motions.motions[:3]))
    with pytest.raises(ValueError, match="no worker 'nobody'"):
        draw_alike(emulator, strangers, 5, np.random.default_rng(0))

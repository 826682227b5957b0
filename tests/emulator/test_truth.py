"""Known truth, learned from 60 made repetitions: is it what 2,000 draws show? And are draws of blocks apart caught?

Bounds on one fit are those of as many true numbers as its recordings tell about the truth, since nobody knows more than
he was shown; bounds on the average over nine fits are about a third of that. ``pytest -m slow -s`` prints the figures.
"""

from itertools import product

import numpy as np
import pytest

from emulator.geometry.alignment import resample
from emulator.geometry.sphere import angle
from emulator.judge.held_out import holm
from emulator.people.population import predictive_sizes
from emulator.people.variance_components import anova
from emulator.synthetic import tasks as synthetic
from tests.emulator import truths
from tests.emulator.truths import BOTH, Crew

CREWS = [Crew(task, 10 * i + j) for (i, task), j in product(enumerate(("reach", "lift", "fasten")), range(3))]
COUPLED = Crew("reach", 0, n_workers=40, share=0.0, correlation=0.42, pace=0.9)
"""Who lifts his hand higher takes longer; who takes longer does so on the way there more than on the way back."""
QUANTILES = (0.05, 0.1, 0.25, 0.5, 0.75, 0.9, 0.95)
slow = [pytest.mark.slow]
schemes = pytest.mark.parametrize("scheme", BOTH)


def each(scheme):
    """(crew, its emulator with this density)."""
    return [(crew, truths.emulator_of(crew, scheme)) for crew in CREWS]


def bonds(performances):
    """Of ``COUPLED``: correlations of log duration with the posture, and of the first part with the rest."""
    posture = truths.latent_of(COUPLED)(performances.scores)
    return np.array([np.corrcoef(posture, np.log(performances.duration_s))[0, 1], truths.first_and_rest(performances)])


def test_one_draw_keeps_the_bonds_of_posture_pace_and_duration_and_blocks_drawn_apart_lose_them():
    """Truth 0.42 and 0.78. Of eight seeds one draw was off by 0.20 and 0.08 at most, blocks apart by 0.38 and 0.22 at
    least, before recordings were mixed and held near their own clock; since then the second by 0.13."""
    truth = np.array([COUPLED.correlation, truths.first_and_rest(truths.fresh(COUPLED))])
    one = truths.drawn(truths.trained(COUPLED)[2])
    off, lost = (np.abs(bonds(some) - truth) for some in (one, truths.apart(one)))
    assert off[0] < 0.21 and off[1] < 0.1
    assert lost[0] > 0.35 and lost[1] > 0.1


def test_blocks_drawn_apart_have_the_margins_of_one_draw():
    """So only what joins them can tell."""
    one = truths.drawn(truths.trained(COUPLED)[2])
    other = truths.apart(one)
    assert np.array_equal(np.sort(one.duration_s), np.sort(other.duration_s))
    assert np.array_equal(np.sort(one.scores, axis=0), np.sort(other.scores, axis=0))


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(3))
def test_sub_task_times_of_one_draw_pass_where_those_of_blocks_apart_fail(seed):
    """240 repetitions, sub-task times, Holm over both."""
    crew = Crew("reach", seed, n_workers=60, n_each=4, share=0.0, correlation=0.3, pace=0.9)
    truth, one = truths.sub_tasks_s(truths.fresh(crew)), truths.drawn(truths.trained(crew)[2])
    joint, split = (
        holm(truths.p_of_n(truths.distances(truths.sub_tasks_s(some), truth), crew.told))
        for some in (one, truths.apart(one))
    )
    assert joint.min() > 0.05
    assert split.min() < 0.01


def of_twenty(emulator):
    """What the variance between workers is multiplied by for a new one: as little is known of it from so few."""
    crew = emulator.workforce
    return (
        1.0
        if crew.population is None or crew.smoothed is None
        else float(np.mean(predictive_sizes(len(crew.names)) ** 2))
    )


class TestOfNineCrews:
    pytestmark = slow

    @schemes
    def test_durations_and_marks_are_as_the_truth_is(self, scheme):
        for crew, emulator in each(scheme):
            distance = truths.distances(truths.times_s(truths.drawn(emulator)), truths.times_s(truths.fresh(crew)))
            assert holm(truths.p_of_n(distance, crew.told)).min() > 0.05, crew

    @schemes
    def test_draws_are_nearer_to_the_truth_than_the_recordings_they_were_learned_from(self, scheme):
        found = []
        for crew, emulator in each(scheme):
            truth = truths.times_s(truths.fresh(crew))
            seen = (truths.drawn(emulator), truths.trained(crew)[0])
            found.append([truths.distances(truths.times_s(some), truth).mean() for some in seen])
        drawn, recorded = np.mean(found, axis=0)
        assert drawn < 0.75 * recorded

    @schemes
    def test_no_quantile_of_the_duration_is_biased(self, scheme):
        error = []
        for crew, emulator in each(scheme):
            three = truths.drawn(emulator), truths.trained(crew)[0], truths.fresh(crew)
            *seen, truth = (np.log(np.quantile(truths.times_s(some)[:, 0], QUANTILES)) for some in three)
            error.append(np.array(seen) - truth)
        bias, rms = np.mean(error, axis=0), np.sqrt(np.mean(np.square(error), axis=0))
        print(scheme, "quantiles, drawn and recorded, bias %", np.round(100 * bias, 1), "rms", np.round(100 * rms, 1))
        assert np.abs(bias[0]).max() < 0.05 and rms[0].mean() < 1.1 * rms[1].mean()

    @schemes
    def test_mean_and_variation_of_the_duration_are_the_training_repetitions(self, scheme):
        """No density takes from the variance learned; to that between workers it adds what so few do not know."""
        for crew, emulator in each(scheme):
            motions = truths.trained(crew)[0]
            learned = anova(np.log(motions.duration_s)[:, None], motions.worker_index)
            many, worker = truths.people(emulator)
            drawn = anova(np.log(many.duration_s)[:, None], worker)
            # A new person repeats what few recordings say, .89-.95 of the variance, and 4 % is chance.
            assert drawn.within_square[0] == pytest.approx(learned.within_square[0], rel=0.15), crew
            of_new = learned.between[0] * of_twenty(emulator)
            assert drawn.between[0] == pytest.approx(of_new, rel=0.35), crew  # 300 people: 8 % of error
            assert emulator.mean_duration_s() == pytest.approx(motions.duration_s.mean(), rel=0.02)

    @schemes
    def test_the_share_between_workers_is_recovered_on_average(self, scheme):
        shares = []
        for _, emulator in each(scheme):
            parts = anova(*_logs(truths.people(emulator)))
            known = parts.between[0] / of_twenty(emulator)
            shares.append([known / (known + parts.within_square[0]), emulator.between_share])
        drawn, claimed = np.mean(shares, axis=0)
        print(scheme, "share drawn", drawn, "claimed", claimed)
        assert abs(drawn - claimed) < 0.03
        assert abs(drawn - CREWS[0].share) < 0.1

    @schemes
    def test_a_worker_varies_as_the_emulator_says(self, scheme):
        for _, emulator in each(scheme):
            rng = np.random.default_rng(5)
            for worker in (emulator.workers[0], emulator.workers[7], emulator.draw_worker(rng)):
                duration_s = emulator.sample(20_000, rng, worker=worker).duration_s
                assert emulator.mean_duration_s(worker) == pytest.approx(duration_s.mean(), rel=0.01)
                assert emulator.duration_cv(worker) == pytest.approx(duration_s.std() / duration_s.mean(), rel=0.03)

    @schemes
    def test_posture_goes_with_duration_as_in_truth(self, scheme):
        whole, within, first = [], [], []
        for crew, emulator in each(scheme):
            latent, (many, worker) = truths.latent_of(crew), truths.people(emulator)
            posture, log_s = latent(many.scores), np.log(many.duration_s)
            whole.append(np.corrcoef(posture, log_s)[0, 1])
            within.append(truths.within_correlation(posture, log_s, worker))
            first.append(truths.first_and_rest(many) - truths.first_and_rest(truths.fresh(crew)))
        print(scheme, *(np.round([np.mean(x), *x], 2) for x in (whole, within, first)))
        assert abs(np.mean(whole) - 0.6) < 0.1 and abs(np.mean(within) - 0.6) < 0.1
        assert min(whole) > 0.3
        assert abs(np.mean(first)) < 0.07 and np.abs(first).max() < 0.25

    @schemes
    def test_the_mean_posture_is_the_true_one_as_nearly_as_that_of_the_recordings(self, scheme):
        """At 21 moments of the own time, in degrees a bone."""
        found = []
        for crew, emulator in each(scheme):
            truth = _mean_posture(synthetic.make(crew.task, 150, 1, seed=7000 + crew.seed)[0])
            drawn = truths.mean_posture(truths.drawn(emulator, 300).directions(n_times=21))
            recorded = _mean_posture(truths.trained(crew)[0])
            found.append([np.degrees(angle(some, truth)).mean() for some in (drawn, recorded)])
        drawn, recorded = np.mean(found, axis=0)
        print(scheme, "mean posture, degrees", drawn, recorded)
        assert drawn < min(1.25 * recorded, 1.0) and np.max(found) < 2.0


def _mean_posture(motions):
    clock = np.linspace(0, 1, 21)
    return truths.mean_posture(np.stack([resample(motion.directions, clock) for motion in motions.motions]))


def _logs(people):
    performances, worker = people
    return np.log(performances.duration_s)[:, None], worker

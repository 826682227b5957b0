import numpy as np
import pytest

from emulator.covariates.table import CovariateTable
from emulator.covariates.validation import icc_2_1, icc_of_the_paper, leave_one_worker_out, rms, sem, validate
from emulator.judge.joint_limits import joint_angles_deg
from emulator.skeleton import standard_skeleton
from emulator.synthetic.choreography import REST, Body, joints_m
from emulator.synthetic.cohort import make_cohort

SKELETON = standard_skeleton()


def bowing(n_people=12, n_each=3, slope=0.3, seed=0):
    """People who bow by 0.5 rad, and by ``slope`` more for each s.d. of height; (directions, table, bones)."""
    rng = np.random.default_rng(seed)
    groups = np.repeat(np.arange(n_people), n_each)
    height = rng.standard_normal(n_people)
    deep = 0.9 + slope * height[groups] + 0.02 * rng.standard_normal(len(groups))
    course = np.sin(np.pi * np.linspace(0, 1, 21)) ** 2
    positions = []
    for one in deep:
        pose = {name: np.tile(value, (21, 1)) for name, value in REST.items()}
        pose["pitch"] = (one * course)[:, None]
        positions.append(joints_m(pose, Body()))
    directions = SKELETON.directions(np.stack(positions))
    table = CovariateTable(
        tuple(f"w{g}" for g in range(n_people)), ("height_z",), height[groups][:, None], (None,) * len(groups), groups
    )
    return directions, table, SKELETON.bone_lengths(positions[0][0])


def judged(**named):
    directions, table, bones = bowing(**named)
    return leave_one_worker_out(directions, table, SKELETON, bones, np.random.default_rng(0), task="bow")


def test_a_body_that_decides_everything_foretells_the_left_out_person():
    found = judged()
    trunk = found.by_body.angles.index("trunk flexion")
    assert np.median(found.by_body.rms_deg[:, trunk]) < 0.5
    assert np.median(found.by_mean.rms_deg[:, trunk]) > 2.0
    assert np.median(found.by_body.icc[:, trunk]) > 0.99
    assert np.all(found.explained >= 1)


def test_a_body_that_decides_nothing_is_the_mean_of_the_others():
    found = judged(slope=0.0)
    assert np.mean(found.explained == 0) > 0.8
    same = found.explained == 0
    assert np.allclose(found.by_body.sem_deg[same], found.by_mean.sem_deg[same])


def test_nobody_s_own_repetitions_tell_of_him():
    """One who bows far deeper than the others: the mean that foretells him is theirs, without a twelfth of him."""
    directions, table, bones = bowing(slope=0.0)
    deep = bowing(n_people=1, slope=0.0, seed=1)[0]
    his = table.groups == 4
    directions[his] = directions[his] + 0.35 * (deep - deep[:, :1])
    directions /= np.linalg.norm(directions, axis=-1, keepdims=True)
    found = leave_one_worker_out(directions, table, SKELETON, bones, np.random.default_rng(0))
    own, others = (
        joint_angles_deg(SKELETON, SKELETON.positions(some.mean(axis=0), bones, np.zeros(3)))["trunk flexion"][:, 0]
        for some in (directions[his], directions[~his])
    )
    trunk = found.by_mean.angles.index("trunk flexion")
    apart = np.sqrt(np.mean((own - others) ** 2))
    assert apart > 1.0
    assert found.by_mean.rms_deg[4, trunk] == pytest.approx(apart, rel=0.03)


def test_nobody_s_own_repetitions_decide_how_many_components_the_others_get():
    """One whose repetitions are full of tracking noise: others' counts change with it, not that of his own fold."""
    directions, table, bones = bowing(n_people=6)
    his = table.groups == 2
    noisy = directions.copy()
    noisy[his] += 0.5 * np.random.default_rng(5).standard_normal((3, 1, *directions.shape[2:]))
    noisy /= np.linalg.norm(noisy, axis=-1, keepdims=True)
    seen = []
    for some in (directions, noisy):
        found = leave_one_worker_out(some, table, SKELETON, bones, np.random.default_rng(0))
        seen.append(found.n_components)
    assert seen[0].shape == (6,)
    assert seen[0][2] == seen[1][2]
    assert np.any(np.delete(seen[0], 2) != np.delete(seen[1], 2))


def test_three_people_of_one_repetition_each_can_be_judged():
    """Two are left in each fold: no parallel analysis, and their covariate is known of too few to be used."""
    found = judged(n_people=3, n_each=1)
    assert found.n_components.tolist() == [1, 1, 1]


def test_angles_that_do_not_move_have_no_icc_but_an_error():
    found = judged()
    bend = found.by_body.angles.index("trunk side bend")
    assert np.all(np.isnan(found.by_body.icc[:, bend]))
    assert np.allclose(found.by_body.sem_deg[:, bend], 0, atol=1e-6)


def test_the_table_has_the_paper_s_figures_beside():
    lines = judged().table()
    assert lines[0].startswith("bow: 12 people, 36 repetitions, ")
    assert lines[2].endswith("0.91 (0.04)") and lines[5].endswith("4.16 (6.80)")
    assert any(line.startswith("  trunk flexion") for line in lines)


def test_two_workers_are_too_few():
    directions, table, bones = bowing(n_people=2)
    with pytest.raises(
        ValueError, match="found 2 workers and 6 rows for 6 repetitions, expected three workers or more"
    ):
        leave_one_worker_out(directions, table, SKELETON, bones, np.random.default_rng(0))


@pytest.mark.slow
def test_bodies_of_the_made_cohort_foretell_better_than_the_mean(capsys):
    """Three made cohorts of lift as the paper's (18 bodies, six paces): SEM at most 0.85 of the mean's in each."""
    for seed in range(3):
        found = validate(make_cohort("lift", seed=seed)[0])
        with capsys.disabled():
            print("\n" + "\n".join(found.table()[:7]))
        assert np.nanmean(found.by_body.sem_deg) < 0.85 * np.nanmean(found.by_mean.sem_deg)
        assert np.nanmean(found.by_body.person_icc) > 0.99


CURVE = 30 * np.sin(np.linspace(0, 6, 80))


def naive_icc_2_1(pair):
    """Shrout & Fleiss (1979), table 1 and the formula of ICC(2,1), from a table (n targets, k judges)."""
    n, k = pair.shape
    grand = pair.mean()
    rows = k * sum((row.mean() - grand) ** 2 for row in pair) / (n - 1)
    columns = n * sum((column.mean() - grand) ** 2 for column in pair.T) / (k - 1)
    total = sum((value - grand) ** 2 for value in pair.ravel())
    rest = (total - rows * (n - 1) - columns * (k - 1)) / ((n - 1) * (k - 1))
    return (rows - rest) / (rows + (k - 1) * rest + k * (columns - rest) / n)


def test_the_naive_twin_gives_the_published_example():
    """Shrout & Fleiss, table 2: six targets, four judges, ICC(2,1) = 0.29."""
    judged = np.array([[9, 2, 5, 8], [6, 1, 3, 2], [8, 4, 6, 8], [7, 1, 2, 6], [10, 5, 6, 9], [6, 2, 4, 7]], float)
    assert naive_icc_2_1(judged) == pytest.approx(0.29, abs=0.005)


def test_it_is_the_naive_twin_curve_by_curve():
    rng = np.random.default_rng(0)
    true = rng.standard_normal((4, 3, 25))
    foretold = 0.7 * true + 0.5 * rng.standard_normal(true.shape) + 0.4
    found = icc_2_1(true, foretold)
    for at in np.ndindex(4, 3):
        assert found[at] == pytest.approx(naive_icc_2_1(np.stack([true[at], foretold[at]], 1)), abs=1e-12)


def test_a_perfect_forecast_is_one_where_the_paper_s_formula_says_a_half():
    assert icc_2_1(CURVE, CURVE) == pytest.approx(1.0)
    assert icc_of_the_paper(CURVE, CURVE) == pytest.approx(0.5)
    assert icc_of_the_paper(CURVE, CURVE[::-1]) == pytest.approx(0.5)
    assert sem(CURVE, CURVE, icc_2_1(CURVE, CURVE)) == pytest.approx(0.0, abs=1e-6)


def test_a_constant_shift_counts_against_it():
    shift, spread = 10.0, CURVE.var(ddof=1)
    assert icc_2_1(CURVE, CURVE + shift) == pytest.approx(2 * spread / (2 * spread + shift**2))


def test_two_constants_that_differ_agree_in_nothing_and_sem_says_by_how_much():
    still = np.zeros(50)
    icc = icc_2_1(still, still + 4.0)
    assert icc == pytest.approx(0.0)
    assert sem(still, still + 4.0, icc) == pytest.approx(2.0, rel=0.02)
    assert np.isnan(icc_2_1(still, still))
    assert sem(still, still, icc_2_1(still, still)) == 0.0


def test_moments_without_an_angle_are_left_out():
    other = CURVE + np.cos(np.linspace(0, 9, 80))
    gapped = CURVE.copy()
    gapped[10:30] = np.nan
    there = np.isfinite(gapped)
    assert icc_2_1(gapped, other) == pytest.approx(icc_2_1(CURVE[there], other[there]))
    assert rms(gapped, other) == pytest.approx(np.sqrt(np.mean((CURVE - other)[there] ** 2)))
    assert icc_of_the_paper(gapped, other) == pytest.approx(icc_of_the_paper(CURVE[there], other[there]))
    nothing = np.full(80, np.nan)
    assert np.isnan(icc_2_1(nothing, other)) and np.isnan(rms(nothing, other))

import numpy as np
import pytest

from emulator.covariates.table import CovariateTable
from emulator.covariates.validation import leave_one_worker_out, validate
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
    """Three made cohorts of lift as seed 004's (18 bodies, six paces): SEM at most 0.85 of the mean's in each."""
    for seed in range(3):
        found = validate(make_cohort("lift", seed=seed)[0])
        with capsys.disabled():
            print("\n" + "\n".join(found.table()[:7]))
        assert np.nanmean(found.by_body.sem_deg) < 0.85 * np.nanmean(found.by_mean.sem_deg)
        assert np.nanmean(found.by_body.person_icc) > 0.99

"""The law of all forward and inverse pairs, and what is particular to one."""

import numpy as np
import pytest

from emulator.geometry import sphere
from emulator.geometry.alignment import align
from emulator.judge import distances, energy_u, reconstruction_error
from emulator.schemes import (
    ISTVF,
    MPCA,
    MTVF,
    SCHEMES,
    SIEM,
    STVF,
    Scheme,
    choose_scheme,
    parallel_analysis,
    search_dimensions,
)
from emulator.schemes.densities import DENSITIES
from emulator.schemes.reductions import fitted
from emulator.schemes.scheme import FITTERS, parsed
from tests.emulator.fitted import recorded
from tests.emulator.schemes.cases import flat_case, grid_case, sequences, walks


@pytest.mark.parametrize("name", SCHEMES)
def test_every_scheme_fits_draws_rebuilds_and_judges(name):
    y = walks()
    dims = (6, 5) if "Sequential" in name or "MPCA" in name else 4 if "Spatial" in name else None
    scheme = Scheme.fit(y, name, dims, order=1 if "VAR" in name else None)
    drawn = scheme.sample(3, np.random.default_rng(0), allow_unstable=True)
    assert drawn.shape == (3, *y.shape[1:]) and np.allclose(np.linalg.norm(drawn, axis=-1), 1)
    again = Scheme.fit(y, name, dims, order=scheme.model.order if "VAR" in name else None)
    assert again.sample(3, np.random.default_rng(0), allow_unstable=True).tobytes() == drawn.tobytes()
    assert reconstruction_error(y, scheme.reconstruct(y)) < 0.6
    assert scheme.log_likelihood(y[:5]).shape == (5,) and np.all(np.isfinite(scheme.log_likelihood(y[:5])))
    assert scheme.coefficients.shape == (len(y), scheme.n_coefficients)


def test_the_schemes_are_the_valid_combinations():
    assert len(set(SCHEMES)) == 6 * (3 * len(DENSITIES) + 2) + 2
    for name in SCHEMES:
        assert name.startswith("PWI") or "/".join(parsed(name)) == name


@pytest.mark.parametrize(
    ("name", "what"),
    [
        ("SIEN/SequentialPCA/MVG", "no 'SIEN', did you mean 'SIEM'"),
        ("IS-TVF/Sequential-PCA/mgv", "did you mean 'SequentialPCA'.*no 'mgv', did you mean 'MVG'"),
        ("SIEM/SpatialPCA/MVG", "MVG does not go with SpatialPCA, which goes with VAR, VAR-pooled"),
        ("pwi/share", "did you mean 'PWI/shared'"),
    ],
)
def test_a_mistyped_scheme_is_refused_with_the_nearest_word(name, what):
    with pytest.raises(ValueError, match=what):
        Scheme.fit(walks(), name)


def test_all_mistakes_are_told_at_once():
    with pytest.raises(ValueError, match=r"directions: found .* expected .*; rho: found 0\.1.*; order: found 3"):
        Scheme.fit(walks()[0], "SIEM/JointPCA/IG", rho=0.1, order=3)


def test_the_start_posture_is_drawn_with_what_follows():
    """Starts of MVG draws are related to scores as those of the training are; those of IG are not."""
    y = walks(40, 30, 4)
    for name, related in (("MVG", True), ("IG", False)):
        scheme = Scheme.fit(y, f"IS-TVF/JointPCA/{name}", 3)
        scores, start = scheme.model.sample(20_000, np.random.default_rng(0), allow_unstable=False)
        drawn, seen = (np.corrcoef(x.T)[:3, 3:] for x in (np.hstack([scores, start]), scheme.coefficients))
        assert np.abs(seen).max() > 0.4
        assert np.abs(drawn - (seen if related else 0)).max() < 0.04


def test_as_many_components_as_there_are_give_the_sequences_back():
    y = sequences(9, 20, 4)
    assert np.abs(Scheme.fit(y, dims=(8, 8)).reconstruct(y) - y).max() < 1e-9


def test_draws_of_the_papers_scheme_have_the_law_of_what_a_gaussian_can_say():
    y = sequences(200, 12, 3, 0.1)
    again = Scheme.fit(y[:100], dims=(6, 8)).sample(300, np.random.default_rng(0))
    apart = energy_u(distances(again, y[100:]), distances(again), distances(y[100:]))
    assert apart < 0.02 * distances(y).mean()


def test_more_numbers_than_the_sequences_span_are_refused_and_by_themselves_fewer_taken():
    y = sequences(9, 40, 20)
    with pytest.raises(ValueError, match="d2: found 30"):
        Scheme.fit(y, dims=(4, 30))
    assert Scheme.fit(y).dims == (10, 8)


def test_dims_by_test_are_those_of_the_search():
    assert Scheme.fit(walks(), dims="test").dims[0] >= 2


INDEX = np.repeat(np.arange(4), 8)


def bowed(rng, kinds):
    """32 sequences (32, 11, 2, 3) that swing to one side, or to the other where ``kinds`` is 2."""
    angle = 0.5 * np.sin(np.linspace(0, np.pi, 11))
    side = np.where(rng.random(32) < 0.5, -1.0, 1.0) if kinds == 2 else np.ones(32)
    size = side * (1 + 0.1 * rng.standard_normal(32))
    at = size[:, None] * angle
    one = np.stack([np.cos(at), np.sin(at), np.zeros_like(at)], axis=-1)
    two = np.stack([np.zeros_like(at), np.sin(at / 2), np.cos(at / 2)], axis=-1)
    return np.stack([one, two], axis=2)


NAMES = ("SIEM/JointPCA/MVG", "SIEM/JointPCA/Kernel")


def test_two_kinds_of_movement_are_told_by_a_kernel_and_not_by_one_gaussian():
    found = choose_scheme(bowed(np.random.default_rng(0), 2), INDEX, NAMES)
    assert found.scheme == "SIEM/JointPCA/Kernel"
    gaussian, kernel = (found.scores[name]["workers"] for name in NAMES)
    assert kernel < 0.9 * gaussian


def test_the_order_of_the_names_decides_nothing():
    given = bowed(np.random.default_rng(1), 2)
    assert choose_scheme(given, INDEX, NAMES).scores == choose_scheme(given, INDEX, NAMES[::-1]).scores


def test_an_unknown_scheme_is_named_before_anything_is_fitted():
    with pytest.raises(ValueError, match="did you mean 'JointPCA'"):
        choose_scheme(np.zeros((0, 1, 1, 3)), INDEX, ("SIEM/JoinPCA/MVG",))


def test_too_few_sequences_are_refused():
    with pytest.raises(ValueError, match="nothing to choose by"):
        choose_scheme(np.ones((3, 2, 1, 3)), np.arange(3), NAMES)


def test_all_mistakes_are_named_at_once():
    given = np.zeros((5, 2, 1, 3))
    with pytest.raises(ValueError, match=r"(?s)no 'SIEMM'.*no 'MVGG'.*worker_index: found float64 of shape .4,."):
        choose_scheme(given, np.zeros(4), ("SIEMM/JointPCA/MVG", "SIEM/JointPCA/MVGG"))
    with pytest.raises(ValueError, match="expected a list of names"):
        choose_scheme(given, np.zeros(5, int), "SIEM/JointPCA/MVG")


FIELDS = ("IS-TVF", "S-TVF", "M-TVF")


@pytest.mark.parametrize("name", FITTERS)
def test_forward_and_inverse_are_a_pair(name):
    y = walks(6, 301, 20)
    there = FITTERS[name](y)
    flat, start = there.forward(y)
    assert flat.shape == ((6, 300, 40) if name in FIELDS else (6, 301, 40))
    assert start.shape == ((6, 40) if name in FIELDS else (6, 0))
    back = there.inverse(flat, start)
    assert np.abs(back - y).max() < 1e-12
    assert np.abs(np.linalg.norm(back, axis=-1) - 1).max() < 1e-13
    one_flat, one_start = there.forward(y[2])
    assert np.allclose(one_flat, flat[2], atol=1e-14) and np.allclose(one_start, start[2], atol=1e-14)
    assert np.allclose(there.inverse(one_flat, one_start), back[2], atol=1e-14)
    flat = 0.9 * flat
    assert np.abs(there.forward(there.inverse(flat, start))[0] - flat).max() < 1e-12


@pytest.mark.parametrize("task", ["deep_squat", "sit_to_stand"])
def test_is_tvf_and_siem_give_recordings_back_to_1e_12(task):
    y = align([m.directions for m in recorded(task).motions[:12]], n_times=301, max_iterations=2).directions
    for name in ("IS-TVF", "S-TVF", "SIEM", "SIEM-moving"):
        there = FITTERS[name](y)
        assert sphere.distance(there.inverse(*there.forward(y)), y).max() < 1e-12, name


def test_the_integral_of_a_field_on_one_sphere_is_the_angle_gone():
    """Known answer: along a great circle through the reference nothing turns, and all representations agree."""
    angle = np.linspace(-0.6, 0.6, 21)
    y = np.stack([np.sin(angle), 0 * angle, np.cos(angle)], axis=-1)[None, :, None]
    integral, start = ISTVF.fit(y).forward(y)
    assert np.allclose(np.linalg.norm(integral[0], axis=-1), angle[1:] - angle[0], atol=1e-12)
    assert np.isclose(np.linalg.norm(start), 0.6, atol=1e-12)
    field, _ = STVF.fit(y).forward(y)
    assert np.allclose(field, np.diff(integral, axis=1, prepend=0.0))
    assert np.allclose(MTVF.fit(y).forward(y)[0], field, atol=1e-12)


def test_m_tvf_hops_through_every_earlier_posture():
    """The definition, hop for hop: from where a step starts back to alpha(0), and from there to the reference."""
    y = walks(2, 9, 3)
    there = MTVF.fit(y)
    field = there.forward(y)[0].reshape(2, 8, 3, 2)
    plane = sphere.basis(there.reference)
    for t in range(8):
        v = sphere.log(y[:, t], y[:, t + 1])
        for k in range(t, 0, -1):
            v = sphere.transport(y[:, k], y[:, k - 1], v)
        v = sphere.transport(y[:, 0], np.broadcast_to(there.reference, v.shape), v)
        assert np.allclose(np.einsum("nbc,bkc->nbk", v, plane), field[:, t], atol=1e-13)


def test_an_m_tvf_taken_back_by_one_hop_goes_wrong_along_time_and_hop_by_hop_it_does_not():
    """Figure 5 of the paper: what grows is the turning between two ways to the reference, not the rounding of hops."""
    y = walks(8, 301, 20)
    there = MTVF.fit(y)
    by_hops, by_one = there.inverse(*there.forward(y)), there.inverse_by_one_hop(*there.forward(y))
    error = sphere.distance(by_one, y).mean(axis=0)
    assert error[1] < 1e-12 and 1e-3 < error[30] < error[120] and error[-1] > 0.05
    assert sphere.distance(by_hops, y).max() < 1e-12


def test_noise_adds_up_along_a_field_and_not_under_siem():
    """A walk of 0.001 rad a step and coordinate: 20 bones are sqrt(pi / 2) 0.001 sqrt(t) each away; SIEM stays."""
    y, rng = walks(40, 301, 20), np.random.default_rng(1)
    frames = np.array([10, 100, 300])
    for fit, grows in ((STVF.fit, np.sqrt(frames)), (SIEM.fit, np.ones(3))):
        there = fit(y)
        flat, start = there.forward(y)
        away = sphere.distance(there.inverse(flat + 1e-3 * rng.normal(size=flat.shape), start), y).mean(axis=0)
        expected = 20 * np.sqrt(np.pi / 2) * 1e-3 * grows
        assert np.all(np.abs(away[frames] / expected - 1) < 0.15), fit


def test_the_moving_frame_turns_no_more_than_the_mean_course():
    y = walks(5, 60, 4)
    there = SIEM.fit_moving(y)
    step = np.diff(there.plane, axis=0)
    moved = sphere.angle(there.reference[1:], there.reference[:-1])
    assert np.all(np.linalg.norm(step, axis=-1) <= moved[..., None] + 1e-12)
    assert np.abs(there.forward(y)[0].mean(axis=0)).max() < 1e-11


def test_another_number_of_times_than_the_moving_mean_is_refused():
    with pytest.raises(ValueError, match="found 39 times, the moving mean has 40"):
        SIEM.fit_moving(walks()).forward(walks()[:, :39])


RNG = np.random.default_rng(0)


@pytest.mark.parametrize(
    ("name", "dims"),
    [("SequentialPCA", (6, 8)), ("MPCA", (6, 14)), ("JointPCA", 8), ("SpatialPCA", 6), ("", None)],
)
def test_all_components_give_back_what_they_were_fitted_to(name, dims):
    flat = flat_case()
    kept = fitted(name, flat, dims, RNG)
    assert kept.dims == (() if dims is None else dims if isinstance(dims, tuple) else (dims,))
    scores = kept.forward(flat)
    assert np.abs(kept.inverse(scores) - flat).max() < 1e-10
    assert np.allclose(kept.forward(flat[3]), scores[3]) and np.allclose(kept.inverse(scores[3]), flat[3])


@pytest.mark.parametrize(("name", "dims"), [("SequentialPCA", (3, 4)), ("MPCA", (3, 4)), ("JointPCA", 4)])
def test_fewer_components_are_a_projection(name, dims):
    flat = flat_case()
    kept = fitted(name, flat, dims, RNG)
    once = kept.inverse(kept.forward(flat))
    assert np.allclose(kept.inverse(kept.forward(once)), once)
    assert 0 < np.sum((once - flat) ** 2) < np.sum((flat - flat.mean(axis=0)) ** 2)


@pytest.mark.parametrize(("dims", "energy"), [((2, 3), 173.67394180506832), ((3, 5), 272.66824683058724)])
def test_mpca_captures_as_much_as_tensorly(dims, energy):
    """tensorly 0.10.0, partial_tucker(x - mean, rank=[d2, d1], modes=[1, 2], init="svd", tol=1e-15)."""
    flat = flat_case()
    kept = MPCA.fit(flat, *dims)
    assert np.isclose(kept.captured, energy, rtol=1e-9)
    assert np.isclose(np.sum(kept.forward(flat) ** 2), energy, rtol=1e-9)
    assert np.allclose(kept.spatial @ kept.spatial.T, np.eye(dims[0]), atol=1e-12)
    assert np.allclose(kept.temporal @ kept.temporal.T, np.eye(dims[1]), atol=1e-12)


@pytest.mark.parametrize(("name", "shape"), [("JointPCA", (8, 5, 1)), ("SpatialPCA", (8, 1, 5))])
def test_principal_components_are_those_of_scikit_learn(name, shape):
    """scikit-learn 1.9.1: p = PCA(3).fit(grid_case(8, 5)); p.components_, p.transform(x)[:3], and what comes back."""
    components = [
        [0.034227353519, -0.494667065999, 0.796216883956, 0.293149500029, -0.185027096455],
        [0.697604745289, 0.015770430545, 0.175490449784, -0.662655453113, -0.207821474746],
        [0.550609123111, -0.116425065237, -0.408667948844, 0.594982151188, -0.402817011914],
    ]
    scores = [
        [-1.419787194817, 1.63701603672, 0.568946252352],
        [1.598673886337, 0.975606067914, -0.135650554526],
        [-0.916358260338, -1.037525641578, -0.346010515447],
    ]
    x = grid_case(8, 5).reshape(shape)
    kept = fitted(name, x, 3, RNG)
    ours = kept.pca.basis if name == "JointPCA" else kept.basis
    sign = np.sign(np.sum(ours * components, axis=1))
    assert np.allclose(sign[:, None] * ours, components, atol=1e-10)
    assert np.allclose(sign * kept.forward(x).reshape(8, 3)[:3], scores, atol=1e-10)
    again = [0.614407192016, 0.044943643, 0.984899845026, 1.139039892872, 0.936512918005]
    assert np.allclose(kept.inverse(kept.forward(x)).reshape(8, 5)[4], again, atol=1e-10)
    if name == "JointPCA":
        assert np.isclose(kept.pca.explained_variance, 0.442598632903 + 0.355785472186 + 0.136672214702, rtol=1e-10)


def test_mpca_captures_no_less_than_components_of_each_mode_alone():
    flat = flat_case()
    first = flat - flat.mean(axis=0)
    space = np.linalg.svd(first.reshape(-1, 6))[2][:2]
    time = np.linalg.svd(np.swapaxes(first, 1, 2).reshape(-1, 14))[2][:3]
    assert MPCA.fit(flat, 2, 3).captured > np.sum((time @ first @ space.T) ** 2)


def test_as_shares_they_take_the_fewest_that_reach_them():
    flat = flat_case()
    for name in ("SequentialPCA", "MPCA"):
        d1, _ = fitted(name, flat, (0.8, 0.5), RNG).dims
        centred = flat - (flat.mean(axis=0) if name == "MPCA" else flat.mean(axis=(0, 1)))
        values = np.linalg.svd(centred.reshape(-1, 6), compute_uv=False) ** 2
        assert values[:d1].sum() >= 0.8 * values.sum() > values[: d1 - 1].sum()


@pytest.mark.parametrize(
    ("name", "dims", "what"),
    [
        ("SequentialPCA", 7, "expected two"),
        ("MPCA", (2, "x"), "expected two"),
        ("MPCA", (7, 2), "d1: found 7"),
        ("MPCA", (1, 14), "14 components of one mode, but with the other only"),
        ("JointPCA", (2, 3), "expected one"),
        ("JointPCA", 99, "span only 8"),
        ("", (2, 3), "keeps every number"),
    ],
)
def test_dims_that_cannot_be_had_are_refused(name, dims, what):
    with pytest.raises(ValueError, match=what):
        fitted(name, flat_case(), dims, RNG)


@pytest.mark.parametrize("shape", [(300, 12), (25, 400)])
def test_parallel_analysis_finds_the_components_that_there_are(shape):
    rng = np.random.default_rng(2)
    hidden = rng.normal(size=(shape[0], 3)) @ rng.normal(size=(3, shape[1]))
    noise = rng.normal(size=shape)
    assert parallel_analysis(3 * hidden + noise, rng) == 3
    assert parallel_analysis(noise, rng) <= 1
    assert fitted("JointPCA", (3 * hidden + noise)[:, :, None], "parallel", rng).dims == (3,)


def test_the_search_takes_more_components_the_more_there_are_and_keeps_what_it_tried():
    y = walks(14, 40, 8)
    siem = SIEM.fit(y)
    found = search_dimensions(siem, y, np.random.default_rng(0))
    assert found.error.shape == (len(found.d1), len(found.d2)) and found.p.shape == (len(found.d2),)
    assert np.all(np.diff(found.error, axis=0) < 1e-5) and np.all(np.diff(found.error, axis=1) < 1e-5)
    at = found.d1.index(found.chosen[0]), found.d2.index(found.chosen[1])
    assert found.p[at[1]] > 0.05 and found.error[at] <= 1.1 * found.error[at[0], -1]
    flat = siem.forward(y)[0]
    kept = fitted("SequentialPCA", flat, (2, 3), RNG)
    poor = siem.inverse(kept.inverse(kept.forward(flat)), np.zeros((14, 0)))
    assert search_dimensions(siem, poor, np.random.default_rng(0)).chosen[0] <= 3 < found.chosen[0]


def test_without_a_wish_bones_that_never_move_take_no_component():
    y = walks(12, 30, 6)
    y[:, :, 3:] = y[0, 0, 3:]
    flat = SIEM.fit(y).forward(y)[0]
    assert fitted("SequentialPCA", flat, None, RNG).dims[0] == fitted("SpatialPCA", flat, None, RNG).dims[0] == 6


def test_mpca_loses_less_than_sequential_pca_only_where_the_mean_course_is_taken_off_first():
    """Figure 9 of the paper says it loses more; that is what its formula without a mean gives."""
    flat = SIEM.fit(walks(20, 60, 6)).forward(walks(20, 60, 6))[0]
    made = (fitted("SequentialPCA", flat, (3, 2), RNG), MPCA.fit(flat, 3, 2), MPCA.fit(flat, 3, 2, centred=False))
    sequential, centred, not_centred = (np.sum((kept.inverse(kept.forward(flat)) - flat) ** 2) for kept in made)
    assert centred < sequential < not_centred

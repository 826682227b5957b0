import numpy as np
import pytest

from emulator.schemes import MPCA, SIEM, parallel_analysis, search_dimensions
from emulator.schemes.reductions import fitted
from tests.emulator.schemes.cases import flat_case, grid_case, walks

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

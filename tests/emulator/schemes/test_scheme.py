import numpy as np
import pytest

from emulator.judge import distances, energy_u, reconstruction_error
from emulator.schemes import SCHEMES, Scheme
from emulator.schemes.scheme import parsed
from tests.emulator.schemes.cases import sequences, walks


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
    assert len(set(SCHEMES)) == 6 * (3 * 3 + 2) + 2
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

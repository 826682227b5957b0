import numpy as np
from scipy.stats import f_oneway

from emulator.covariates.distribution import f_test, left_out_effects, level_effects, levels_of, members

WORDS = ["f", "m", "f", None, "m", "x", "f", "m", "f"]


def test_levels_are_those_of_two_people_or_more():
    assert levels_of(WORDS) == ("f", "m")
    assert levels_of(["f", "f", "m"]) == ()
    assert levels_of(None) == ()


def test_the_f_test_is_that_of_scipy_without_people_of_no_level():
    residual = np.random.default_rng(0).standard_normal((9, 4))
    p = f_test(residual, members(WORDS, ("f", "m")))
    own = [residual[[i for i, word in enumerate(WORDS) if word == level]] for level in ("f", "m")]
    assert np.allclose(p, f_oneway(*own).pvalue)


def test_three_levels_are_tested_together():
    words = list("aabbccabc")
    residual = np.random.default_rng(1).standard_normal((9, 3))
    own = [residual[[i for i, word in enumerate(words) if word == level]] for level in "abc"]
    assert np.allclose(f_test(residual, members(words, ("a", "b", "c"))), f_oneway(*own).pvalue)


def test_scores_without_spread_inside_the_levels_cannot_be_tested():
    assert np.isnan(f_test(np.array([[1.0], [2.0], [1.0], [2.0]]), members(["f", "m", "f", "m"], ("f", "m")))[0])


def test_effects_are_level_means_that_weigh_to_zero():
    residual = np.random.default_rng(2).standard_normal((9, 2))
    member = members(WORDS, ("f", "m"))
    effect = level_effects(residual, member)
    assert np.allclose(member.sum(0) @ effect, 0)
    assert np.allclose(effect[0] - effect[1], residual[[0, 2, 6, 8]].mean(0) - residual[[1, 4, 7]].mean(0))


def test_left_out_effects_are_fits_without_the_person():
    rng = np.random.default_rng(3)
    residual, member = rng.standard_normal((9, 9, 2)), members(WORDS, ("f", "m"))
    found = left_out_effects(residual, member)
    for g, word in enumerate(WORDS):
        if word in ("f", "m"):
            others = [h for h in range(9) if h != g]
            effect = level_effects(residual[g][others], member[others])
            assert np.allclose(found[g], effect[("f", "m").index(word)])
        else:
            assert np.all(found[g] == 0)

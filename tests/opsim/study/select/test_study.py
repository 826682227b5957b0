"""From what is asked to who is best, on made answers: which replications are asked for, limits, searches, refusals."""

import json
from types import SimpleNamespace

import numpy as np
import pytest
from pydantic import ValidationError
from scipy import stats

from opsim.problems import ScenarioError
from opsim.report.page import study_html
from opsim.report.studies.selection import select_page
from opsim.report.studies.selection_charts import rows_of, welch_half_width
from opsim.report.studies.selection_sentences import _flattered
from opsim.scenario.schema.studies import Select
from opsim.study.intervals import Interval
from opsim.study.jobs import Job, Point
from opsim.study.select.search import OptunaSearch, Trial, best_trials, candidates_of
from opsim.study.select.selection import Limit, Replications
from opsim.study.select.study import _trial, choose, kept_of, summary_of

KEYS = [("throughput_per_h", "", "", "1/h"), ("rula_mean", "", "worst", "1"), ("time_in_system_s", "", "", "s")]
MEANS = {"base": (50, 5.0, 900), "three": (55, 4.0, 800), "five": (60, 4.5, 700), "nine": (62, 6.0, 650)}


class Made:
    """Answers with these means: ``mean_of(point)`` of each key, all with some luck in common."""

    def __init__(self, mean_of, sd=1.0, missing=()):
        self.mean_of, self.sd, self.missing, self.asked = mean_of, sd, missing, []
        self.source = None

    def check(self, points):
        self.checked = list(points)

    def keys(self, jobs):
        return KEYS

    def values(self, jobs, keys):
        self.asked += jobs
        return np.array([[self._value(job, KEYS.index(key)) for key in keys] for job in jobs]).reshape(
            len(jobs), len(keys)
        )

    def _value(self, job, column):
        if (job.point.name, job.replication) in self.missing:
            return np.nan
        own = np.random.default_rng([job.replication, column, int(job.point.key, 16) % 2**32]).normal()
        common = np.random.default_rng([job.replication, column]).normal()
        return self.mean_of(job.point)[column] + self.sd * (0.1 if column == 1 else 1) * (0.6 * own + 0.8 * common)


def variants(point):
    return MEANS[point.name]


def asked(**said):
    return Select(**{"indifference": 1, "replications": 20, **said})


def found_of(said, answers=None, search=None):
    block = asked(**said)
    candidates = candidates_of(block, list(MEANS), "base")
    answers = Made(variants) if answers is None else answers
    return choose(block, candidates, answers, search), answers


def screen(found):
    return " ".join(select_page(found, "Made").answer)


def test_the_best_is_chosen_and_looked_at_again_on_numbers_beyond_those_used():
    found, answers = found_of({})
    assert found.winner == "nine" and found.fresh.n == 20
    chosen = {job.replication for job in answers.asked if job.replication < found.fresh.first}
    assert chosen == set(range(found.fresh.first))
    assert {job.replication for job in answers.asked} - chosen == set(range(found.fresh.first, found.fresh.first + 20))
    assert abs(found.fresh.difference.mean - 12) < 1 and found.fresh.difference.n == 20


def test_what_is_said_is_what_an_engineer_would_say():
    said = screen(found_of({})[0])
    assert said.startswith(
        "With at least 95 % confidence 'nine' is the best of 4, or (by experience, not proof) within 1 per hour of it: "
    )
    assert "on 20 fresh replications" in said and "per hour more than 'base'." in said
    assert "were out after 10 replications" in said


def test_a_limit_changes_who_is_best():
    found, _ = found_of({"subject_to": ["rula_mean/worst <= 4.8 +- 0.1"]})
    assert found.winner == "five" and {out.system for out in found.selection.out if out.limit} == {"base", "nine"}
    said = screen(found)
    assert "the best of those of 4 that keep the limit" in said and "at most 4.8 is allowed" in said
    assert "which does not keep the limit" in said


def test_where_nobody_keeps_the_limit_the_nearest_is_named():
    said = screen(found_of({"subject_to": ["rula_mean/worst <= 3"]})[0])
    assert "Nobody is chosen: none of 4 keeps the limit (at most 3)." in said and "Nearest is 'three'" in said


def test_less_is_better_of_a_time():
    found, _ = found_of({"figure": "time_in_system_s", "indifference": "2 s"})
    assert (found.winner, found.indifference) == ("nine", 2.0) and found.fresh.difference.mean < -200


def test_per_cent_are_of_the_base_on_replications_of_their_own():
    found, answers = found_of({"indifference": "2 %"})
    assert found.first == 10 and abs(found.indifference - 1.0) < 0.03
    assert {job.point.name for job in answers.asked if job.replication < 10} == {"base"}


@pytest.mark.parametrize("procedure", ["rinott", "dudewicz-dalal", "ocba"])
def test_procedures_for_independent_variants_give_each_its_own_numbers(procedure):
    found, answers = found_of({"procedure": procedure})
    of = {}
    for job in answers.asked:
        if job.replication < found.fresh.first:
            of.setdefault(job.point.name, set()).add(job.replication)
    assert found.winner == "nine" and len(set.union(*of.values())) == sum(map(len, of.values()))
    assert study_html(select_page(found, "Made"))


def test_nobody_is_called_best_where_replications_ran_out():
    found, _ = found_of({"most_replications": 12, "indifference": 0.01}, Made(lambda point: (50, 4, 800), sd=5.0))
    assert not found.winner and found.fresh is None
    said = screen(found)
    assert (
        "still too close to tell after 12 replications, the most allowed" in said
        and "So many replications tell" in said
    )
    enough = found.selection.affordable
    assert found_of({"most_replications": 12, "indifference": enough}, Made(lambda point: (50, 4, 800), sd=5.0))[
        0
    ].winner
    found, _ = found_of({"procedure": "rinott", "most_replications": 30, "indifference": 0.01})
    assert "would need" in screen(found) and "at most 30 are allowed" in screen(found)


def test_a_limit_that_is_open_is_not_called_too_close_to_tell():
    """Means far apart, and a figure at its limit: a larger indifference would change nothing."""
    said = {"subject_to": ["rula_mean/worst <= 4 +- 0.001"], "most_replications": 30, "variants": ["base", "three"]}
    means = {"base": (50, 4, 900), "three": (60, 4, 800)}
    found, _ = found_of(said, Made(lambda point: means[point.name]))
    words = screen(found)
    assert "whether 'base' and 'three' keep the limit is open after 30 replications, the most allowed" in words
    assert "To know who keeps the limit, allow more replications (--most), or a wider +-" in words
    assert "too close" not in words and "--indifference" not in words
    assert json.loads(json.dumps(summary_of(found)))["open_pairs"] == [] and len(found.selection.open_limits) == 2


def test_two_that_never_differed_are_called_the_same_without_a_confidence():
    same = {name: Point("same", {}) for name in MEANS}
    made = Made(lambda point: (50, 4, 800))
    one = made._value
    made._value = lambda job, column: one(Job(same["base"], job.replication), column)
    said = screen(found_of({"most_replications": 60}, made)[0])
    assert said.startswith(
        "The best of 4 are 'base', 'three', 'five' and 'nine', the same in all 59 replications: take"
    )
    assert "(they hardly differ in more than 5.1 % of replications)" in said and "confidence" not in said


@pytest.mark.parametrize("procedure", ["rinott", "ocba"])
def test_how_far_variants_with_numbers_of_their_own_are_behind_has_an_interval(procedure):
    found, _ = found_of({"procedure": procedure})
    selection = found.selection
    rows = {row[0]: row[3] for row in rows_of(found)}
    a, b = (selection.values[selection.systems.index(name)][:, 0] for name in ("nine", "base"))
    known = stats.ttest_ind(a, b, equal_var=False).confidence_interval()
    assert welch_half_width(a, b) == pytest.approx((known.high - known.low) / 2)
    assert " ± " in rows["base"] and rows["nine"] == ""


def test_the_base_as_the_best_is_nothing_to_change():
    found, _ = found_of({"base": "nine"})
    assert found.fresh.difference is None and "nothing is to be changed" in screen(found)


def test_every_combination_of_values_is_compared_and_called_by_them():
    said = {"vary": {"stations.saw.buffer": [1, 2], "release.every": ["40 s", "50 s"]}}
    found, _ = found_of(said, Made(lambda p: (50 + 3 * p.changes.get("stations.saw.buffer", 0), 4, 800)))
    assert list(found.changes)[1] == "buffer 1, every 50 s" and found.winner.startswith("buffer 2")


def hill(point):
    """Best at 0.7 of x; b is good and breaks the limit."""
    x = point.changes.get("run.x", 0.0)
    kind = point.changes.get("run.kind", "a")
    return 60 - 40 * (x - 0.7) ** 2 + (5 if kind == "b" else 0), 6.0 if kind == "b" else 4.0, 800


def search_of(monkeypatch, refused=()):
    monkeypatch.setattr("opsim.study.select.study._refused", lambda answers, point: "no" if refused else "")
    said = {"vary": {"run.x": {"from": 0.0, "to": 1.0}, "run.kind": ["a", "b"]}, "search": True, "trials": 24,
            "subject_to": ["rula_mean/worst <= 5"]}  # fmt: skip
    block = asked(**said)
    candidates = candidates_of(block, list(MEANS), "base")
    return choose(block, candidates, Made(hill), OptunaSearch(candidates.factors, 7, candidates.trials))


def test_a_search_finds_the_hill_keeps_the_limit_and_says_how_much_it_flattered(monkeypatch):
    found = search_of(monkeypatch)
    best = found.changes[found.winner]
    assert abs(best["run.x"] - 0.7) < 0.15 and best["run.kind"] == "a"
    assert len(found.searched.trials) == 24 and found.first == 3
    said = screen(found)
    assert (
        "The search tried 24 points on 3 replications each; the best 5 went on" in said
        and " than the fresh ones" in said
    )
    assert "the best of those of 5 that keep the limit" in said and f"'{found.winner}' (x 0." in said


@pytest.mark.parametrize(("seen", "better", "words"), [
    (Trial({}, 42.8, (), half_width=1.2), "more", "42.8 per hour for the chosen one, 0.4 more than the fresh ones"),
    (Trial({}, 42.8, (), half_width=0.1), "more", "0.4 more than the fresh ones (may be chance)"),
    (Trial({}, 44.8, (), half_width=1.2), "more", "2.4 more than the fresh ones: the best of many looks better"),
    (Trial({}, 40.8, (), half_width=1.2), "less", "1.6 less than the fresh ones: the best of many looks better"),
    (Trial({}, 40.8, (), half_width=1.2), "more", "1.6 less than the fresh ones (may be chance)"),
    (Trial({}, 49.9, ()), "more", "7.5 more than the fresh ones (may be chance)"),
])  # fmt: skip
def test_that_the_best_of_many_flatters_is_said_where_both_errors_leave_it(seen, better, words):
    found = SimpleNamespace(key=KEYS[0], better=better)
    assert words in _flattered(seen, Interval(42.4, 0.5, 0.7, 10), found)


def test_limits_of_different_units_are_held_against_their_tolerances():
    """30 s beyond 600 s +- 60 s is nearer than 0.3 points beyond 4 +- 0.1, which a sum of both would call nearer."""
    means = {0: (50, 4.0, 630), 1: (50, 4.3, 600)}
    seen = Made(lambda point: means[point.changes["run.x"]], sd=0.0)
    limits = [Limit("time", 600.0, 60.0), Limit("rula", 4.0, 0.1)]
    looking = Replications(seen, (), (KEYS[0], KEYS[2], KEYS[1]), 0)
    points = [Point("x", {"run.x": x}) for x in means]
    trials = [
        _trial(point, seen.values([Job(point, r) for r in range(3)], looking.keys), looking, limits) for point in points
    ]
    assert [trial.over for trial in trials] == [pytest.approx((0.5, 0.0)), pytest.approx((0.0, 3.0))]
    assert best_trials(trials[::-1], 1, 1.0) == [trials[0]]


def test_a_search_is_the_same_every_time(monkeypatch):
    one, other = (json.dumps(summary_of(search_of(monkeypatch))) for _ in range(2))
    assert one == other


def test_a_search_of_which_nothing_can_be_run_is_refused(monkeypatch):
    with pytest.raises(ValueError, match="not one of 24 trials could be run; the first: no"):
        search_of(monkeypatch, refused=True)


def test_the_summary_is_plain_json_and_the_page_escapes_names():
    found, _ = found_of({"subject_to": ["rula_mean/worst <= 4.8"]})
    text = json.dumps(summary_of(found))
    assert json.loads(text)["winner"] == "five"
    means = dict(zip(["base", "<b>x</b>"], MEANS.values()))
    block = asked()
    points = tuple(Point(name, {"run.x": place}, "base") for place, name in enumerate(means))
    candidates = candidates_of(block, list(MEANS), "base").__class__(points, points[0])
    page = study_html(select_page(choose(block, candidates, Made(lambda p: means[p.name])), "Made"))
    assert "<b>x</b>" not in page and "&lt;b&gt;x" in page


@pytest.mark.parametrize(("said", "words"), [
    ({"variants": ["base"]}, "only 'base' is there: nothing to choose from"),
    ({"variants": ["base", "fife"]}, "no variant 'fife'; did you mean 'five'?"),
    ({"base": "bass"}, "no variant 'bass'; did you mean 'base'?"),
    ({"confidence": 0.2}, "confidence: expected a number between 0.25"),
    ({"vary": {"run.x": [1]}}, "only one combination"),
    ({"vary": {"run.x": {"from": 0, "to": 9}}}, "run.x: a range has no end of values"),
    ({"vary": {"run.x": [1, 2]}, "search": True}, "only 2 combinations; without --search all of them"),
    ({"vary": {f"run.x{i}": [1, 2, 3, 4] for i in range(6)}}, "4,096 combinations, at most 2,000"),
])  # fmt: skip
def test_a_choice_that_is_none_is_refused_before_anything_is_run(said, words):
    with pytest.raises(ValueError, match=words):
        candidates_of(asked(**said), list(MEANS), "base")


@pytest.mark.parametrize(("said", "words"), [
    ({"figure": "takt_s"}, "nothing says whether more or less of takt_s is better"),
    ({"figure": "more takt_s", "indifference": "1 s"}, "no figure 'takt_s' in this scenario"),
    ({"subject_to": ["rula_mean/ana <= 4"]}, "no figure 'rula_mean/ana' in this .*; did you mean 'rula_mean/worst'"),
    ({"subject_to": ["rula_men <= 4"]}, "unknown figure 'rula_men'"),
    ({"subject_to": ["rula_mean 4"]}, "no limit: 'rula_mean 4'"),
    ({"subject_to": ["time_in_system_s <= 600"]}, "600 has no unit"),
    ({"indifference": 0}, "expected more than 0, found 0"),
    ({"indifference": "2 s"}, "'2 s': throughput_per_h is per hour: write 2"),
    ({"indifference": None}, "nothing says which difference is too small to matter"),
    ({"first_replications": 4}, "greater than or equal to 5|at least 5|5 or more"),
    ({"trials": 20}, "a search needs to know what it may vary"),
    ({"procedure": "rinott", "subject_to": ["rula_mean <= 4"]}, "the procedure rinott knows no limits"),
    ({"vary": {"run.x": [1, 2]}, "variants": ["base"]}, "either the file's variants or what is varied"),
])  # fmt: skip
def test_a_wrong_question_is_refused_in_words(said, words):
    with pytest.raises((ValueError, ValidationError), match=words):
        found_of(said)


def test_a_replication_without_the_figure_is_named():
    with pytest.raises(ValueError, match="five: throughput_per_h: nothing was observed in replication 4"):
        found_of({}, Made(variants, missing=[("five", 4)]))


def test_points_are_checked_before_the_first_run():
    class Wrong(Made):
        def check(self, points):
            raise ScenarioError([])

    answers = Wrong(variants)
    with pytest.raises(ScenarioError):
        found_of({}, answers)
    assert not answers.asked


def test_kept_are_the_figures_that_are_asked_of():
    assert kept_of(asked(subject_to=["rula_mean/worst <= 4"])) == ("throughput_per_h", "rula_mean")

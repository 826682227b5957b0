"""From what is asked to who is best, on made answers: which replications are asked for, limits, searches, refusals."""

import json

import numpy as np
import pytest
from pydantic import ValidationError

from opsim.problems import ScenarioError
from opsim.report.select_page import select_page
from opsim.report.study_page import study_html
from opsim.scenario.schema.studies.select import Select
from opsim.study.jobs import Point
from opsim.study.select.candidates import candidates_of
from opsim.study.select.optuna_search import OptunaSearch
from opsim.study.select.study import choose, kept_of
from opsim.study.select.summary import summary_of

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
    assert said.startswith("With at least 95 % confidence 'nine' is the best of 4, or within 1 per hour of it: 6")
    assert "on 20 fresh replications" in said and "per hour more than 'base'." in said
    assert "were out after 10 replications" in said


def test_a_limit_changes_who_is_best():
    found, _ = found_of({"subject_to": ["rula_mean/worst <= 4.8 +- 0.1"]})
    assert found.winner == "five" and {out.system for out in found.selection.out if out.limit} == {"base", "nine"}
    said = screen(found)
    assert "the best of 4 that keeps the limit" in said and "at most 4.8 is allowed" in said
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
    assert "still too close to tell after 12 replications each" in said and "So many replications tell" in said
    enough = found.selection.affordable
    assert found_of({"most_replications": 12, "indifference": enough}, Made(lambda point: (50, 4, 800), sd=5.0))[
        0
    ].winner
    found, _ = found_of({"procedure": "rinott", "most_replications": 30, "indifference": 0.01})
    assert "would need" in screen(found) and "at most 30 are allowed" in screen(found)


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
    assert "The search tried 24 points on 3 replications each; the best 5 went on" in said and "too " in said
    assert "the best of 5" in said and f"'{found.winner}' (x 0." in said


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

import pytest

from opsim.problems import MOST_SHOWN, Problem, ScenarioError, did_you_mean, nearest, shown


def test_a_problem_points_with_a_caret_at_its_column():
    problem = Problem("line.yaml", 12, 5, "run.sed", "unknown key 'sed'", "did you mean 'seed'?", "run: {sed: 7}")
    assert str(problem) == (
        "line.yaml:12:5: run.sed: unknown key 'sed'\n    12 | run: {sed: 7}\n       |     ^ did you mean 'seed'?"
    )


def test_a_long_line_is_shown_around_its_column():
    line = "x" * 5000 + "HERE" + "y" * 5000
    printed = str(Problem("a.yaml", 1, 5001, "", "found it", "", line)).splitlines()
    assert max(map(len, printed)) < 200
    assert printed[1][printed[2].index("^") :].startswith("HERE")


def test_the_total_counts_all_and_shows_the_first():
    error = ScenarioError([Problem("a.yaml", n, 1, "", f"wrong {n}") for n in range(1, 101)])
    assert str(error).count("wrong") == MOST_SHOWN
    assert str(error).endswith(f"100 problems in a.yaml (the first {MOST_SHOWN} are shown)")


@pytest.mark.parametrize(
    ("value", "words"),
    [
        (None, "nothing"),
        (True, "true"),
        ("a\x1b[31m", "'a\\x1b[31m'"),
        ({}, "a block of keys"),
        ([], "an empty list"),
        (2, "2"),
    ],
)
def test_a_value_is_shown_in_printable_words(value, words):
    assert shown(value) == words
    assert len(shown("x" * 10_000)) <= 60


def test_the_nearest_word_is_found_whatever_its_case():
    assert nearest("Pelvsi", ["pelvis", "spine"]) == "pelvis"
    assert nearest("zebra", ["pelvis", "spine"]) is None
    assert did_you_mean("zebra", ["pelvis", "spine"]) == "known: pelvis, spine"
    assert did_you_mean("zebra", []) == ""

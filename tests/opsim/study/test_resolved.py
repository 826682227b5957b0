import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from opsim.scenario.yaml import read_tree
from opsim.study.resolved_scenario import decides_figures, differences, read_resolved, resolved_text, with_run

TEXTS = st.one_of(
    st.text(st.characters(exclude_categories=("Cs", "Cc", "Cf", "Co", "Cn", "Zl", "Zp")), max_size=40),
    st.from_regex(r"\A[-+.0-9eExoOaAnNuUlLtTrR~: ]{0,8}\Z"),
    st.sampled_from(["1e5", "2E1", "0o17", "0x1f", "no", "null", "~", ".inf", "10:30", "+.5", "1.", "-0", "=", "<<"]),
)
HANDS = ("loaded.from", "handling.grip")
VALUES = st.one_of(TEXTS, st.integers(), st.floats(allow_nan=False), st.booleans(), st.none())
KEYS = TEXTS.filter(lambda key: key != "<<")


@pytest.mark.parametrize("text", ["1e5", "2E1", "0o17", "1.", ".5", "no", "yes", "10:30", "2026-01-01", "0x1f", ""])
def test_a_text_that_looks_like_a_number_is_read_back_as_text(text):
    assert read_resolved(resolved_text({"name": text, "libraries": {text: text}})) == {
        "name": text,
        "libraries": {text: text},
    }


@settings(max_examples=80, deadline=None)
@given(st.dictionaries(KEYS, st.one_of(VALUES, st.lists(VALUES, max_size=4), st.dictionaries(KEYS, VALUES))))
def test_whatever_was_resolved_is_read_back_the_same(resolved):
    root, problems = read_tree(resolved_text(resolved).encode(), "scenario.resolved.yaml")
    assert root.plain() == resolved and not problems


def test_what_two_entries_share_is_written_twice():
    shared = {"walk": "1 m/s"}
    assert "&" not in resolved_text({"ana": shared, "ben": shared})


def test_differences_are_named_by_path_and_what_decides_no_row_is_none():
    run = {"horizon": "8 h", "seed": 1}
    before = {"name": "a", "run": run, "outputs": ["x"], "workers": {"ana": {}}}
    now = {"name": "b", "run": {**run, "horizon": "4 h", "warm_up": "1 h", "seed": 2}, "workers": {"ana": {}, "eva": 1}}
    assert differences(before, now) == ["run.horizon 8 h, now 4 h", "workers.eva not there, now 1"]
    assert differences(before, before) == []


BODIES = {
    "ergonomics": {"rate": 12},
    "tasks": {"lift": {"load": "8 kg", "loaded": {"from": "grasp"}, "handling": {"grip": "fair"}}},
}
OTHER_BODIES = {
    "ergonomics": {"rate": 4, "waiting": "upright"},
    "tasks": {"lift": {"load": "9 kg", "loaded": {"from": "start"}, "handling": {"grip": "poor"}}},
}
SCORES, LOADS = {"ergonomics.rate", "ergonomics.waiting"}, {f"tasks.lift.{k}" for k in ("load", *HANDS)}


@pytest.mark.parametrize(
    "asks, decide",
    [
        ({}, set()),
        ({"human": {"fatigue": {"model": "lffrm", "by": "even"}}}, set()),
        ({"human": {"fatigue": {"model": "lffrm"}, "learning": {"model": "wright"}}}, set()),
        ({"allocation": {"rule": "nearest"}, "rotations": {"r": {"rule": "in_turn"}}}, set()),
        ({"human": {"fatigue": {"model": "lffrm", "by": "posture"}}}, LOADS),
        ({"human": {"fatigue": {"model": "3cc_r"}}}, LOADS),
        ({"allocation": {"rule": "least_exposed"}}, SCORES | LOADS),
        ({"rotations": {"r": {"rule": "least_exposed"}}}, SCORES | LOADS),
    ],
)
def test_loads_and_scores_decide_rows_only_where_something_asks_for_them(asks, decide):
    before, now = {**BODIES, **asks}, {**OTHER_BODIES, **asks}
    assert {words.split(" ")[0] for words in differences(before, now)} == decide
    assert set(decides_figures(now)) == (SCORES | LOADS) - decide
    for one in (before, now):
        assert decide.isdisjoint(decides_figures(one))


def test_a_task_that_is_named_like_a_key_is_a_task():
    before, now = ({"tasks": {"load": {"fixed": seconds}, "a.load": {"fixed": "1 s"}}} for seconds in ("1 s", "2 s"))
    assert differences(before, now) == ["tasks.load.fixed 1 s, now 2 s"]


def test_the_file_says_the_seed_and_the_number_that_were_used():
    assert with_run({"run": {"horizon": "8 h", "seed": 1}}, 9, 3)["run"] == {
        "horizon": "8 h",
        "seed": 9,
        "replications": 3,
    }

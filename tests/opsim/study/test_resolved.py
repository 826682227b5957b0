import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from opsim.scenario.yaml_nodes import read_tree
from opsim.study.resolved import differences, read_resolved, resolved_text, with_run

TEXTS = st.one_of(
    st.text(st.characters(exclude_categories=("Cs", "Cc", "Cf", "Co", "Cn", "Zl", "Zp")), max_size=40),
    st.from_regex(r"\A[-+.0-9eExoOaAnNuUlLtTrR~: ]{0,8}\Z"),
    st.sampled_from(["1e5", "2E1", "0o17", "0x1f", "no", "null", "~", ".inf", "10:30", "+.5", "1.", "-0", "=", "<<"]),
)
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


def test_the_file_says_the_seed_and_the_number_that_were_used():
    assert with_run({"run": {"horizon": "8 h", "seed": 1}}, 9, 3)["run"] == {
        "horizon": "8 h",
        "seed": 9,
        "replications": 3,
    }

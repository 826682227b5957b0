"""Studies of a file, checked without a run: what is varied, which figures, variants, people, places."""

from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from opsim.problems import ScenarioError
from opsim.scenario.paths import keys_of
from opsim.scenario.read import read_scenarios
from opsim.scenario.schema.studies import Studies
from opsim.scenario.study_checks import Varied, change_problems, check_study, study_problems
from opsim.study.resolved_scenario import decides_figures, decides_rows

GOOD = (Path(__file__).parent / "good.yaml").read_text(encoding="utf-8")
VARIED = Varied.read(Path(__file__).parent / "good.yaml")


def file_with(folder, studies, *edits):
    text = GOOD
    for old, new in edits:
        assert old in text
        text = text.replace(old, new)
    path = folder / "line.yaml"
    path.write_text(f"{text}studies:\n{studies}\n", encoding="utf-8")
    return path


def wrong(folder, studies, *edits):
    """(line, path, message, hint) of everything that is wrong."""
    try:
        check_study(Varied.read(file_with(folder, studies, *edits)))
    except ScenarioError as error:
        return [(one.line, one.path, one.message, one.hint) for one in error.problems]
    return []


def test_studies_that_are_right_are_right(tmp_path):
    asked = """
  sweep: {vary: {stations.pack.buffer: [1, 2], release.every: {from: 40 s, to: 1 min 10 s}}, figures: [walked_m/ana]}
  labour: {figures: [worker_states/ben/wait], buy_back: {like: [ana]}}
  layout: {fixed: [pack], places: [door, bench], move: ['bench=2 m, 2 m']}
"""
    assert wrong(tmp_path, asked.replace("1 min 10 s", "70 s").strip("\n")) == []


def test_every_wrong_value_is_said_at_its_place(tmp_path):
    found = wrong(
        tmp_path,
        """
  sweep:
    vary:
      stations.pack.buffer: [1, -2]
      stations.pak.buffer: [1]
      release.every: {from: 0 s, to: 50 s}
      workers.ana.skills: [{}, {pack: 1}]
    figures: [walked_m/an]
""".strip("\n"),
    )
    assert found == [
        (26, "stations.pack.buffer", "must be at least 0, found -2", "write 2, without the minus"),
        (27, "stations.pak.buffer", "no 'pak' among the stations", "did you mean stations.pack.buffer?"),
        (28, "release.every", "must be more than 0 s, found '0 s'", "such as '45 s'"),
        (
            29,
            "studies.sweep.vary.workers.ana.skills",
            "with workers.ana.skills: {}: stations.pack: "
            "task 'lift' needs a worker, and no worker has the skill 'pack'",
            "add 'pack: 1.0' to the skills of ana or another worker",
        ),
        (30, "studies.sweep.figures", "walked_m/an: no worker 'an'", "did you mean 'ana'?"),
    ]


def test_names_of_a_layout_study_are_looked_up(tmp_path):
    asked = "  layout: {fixed: [pak], swap: ['pack,pak'], what_ifs: {far: ['place pack=bensh']}}"
    assert [hint for *_, hint in wrong(tmp_path, asked)] == [
        "did you mean 'pack'?",
        "did you mean 'pack'?",
        "did you mean 'bench'?",
    ]


def test_a_mistyped_path_adds_no_station_and_a_whole_new_one_does(tmp_path):
    asked = "  sweep: {vary: {stations.pak.buffer: [1, 2]}}\n  layout: {fixed: [zzz]}"
    assert [hint for *_, hint in wrong(tmp_path, asked)] == [
        "did you mean stations.pack.buffer?",
        "known stations: pack",
    ]
    added = "  sweep: {vary: {workers.cai: [{like: ana}, {like: ben}]}}\n  labour: {buy_back: {like: [cai]}}"
    assert wrong(tmp_path, added) == []


@pytest.mark.parametrize(
    ("verb", "key", "hint"),
    [
        ("select", "best", "the key of --best is 'figure'"),
        ("select", "among", "the key of --among is 'variants'"),
        ("select", "most", "the key of --most is 'most_replications'"),
        ("labour", "no-buy-back", "--no-buy-back is buy_back: off in a file"),
        ("labour", "most_workers", "--most-workers is buy_back.most_workers in a file"),
        ("sweep", "horizon", "--horizon is run.horizon in a file"),
        ("sweep", "figure", "the key of --figure is 'figures'"),
    ],
)
def test_an_option_among_the_keys_of_a_study_is_answered_with_its_key(tmp_path, verb, key, hint):
    found = wrong(tmp_path, f"  {verb}: {{{key}: 1}}")
    assert hint in [hint for _, path, _, hint in found if path.endswith(key)]


def test_all_keys_of_a_block_are_named(tmp_path):
    hint = next(hint for _, path, _, hint in wrong(tmp_path, "  select: {xyzzy: 1}") if path.endswith("xyzzy"))
    assert hint.startswith("keys here: ") and set(hint.removeprefix("keys here: ").split(", ")) == {
        *BLOCKS["select"].model_fields
    }


def test_variants_of_a_study_are_looked_up(tmp_path):
    asked = "  select: {indifference: 1, variants: [base, neer]}"
    assert [(path, message, hint) for _, path, message, hint in wrong(tmp_path, asked)] == [
        ("studies.select.variants", "no variant 'neer' in this file", "did you mean 'near'?")
    ]


def test_mistakes_of_the_scenario_and_of_its_studies_are_said_together_and_once(tmp_path):
    asked = "  sweep: {vary: {stations.pack.bufer: [1], run.horizon: [4 h, 5 h]}}"
    found = wrong(tmp_path, asked, ("servers: 2", "server: 2"))
    assert [message for _, _, message, _ in found] == ["unknown key 'server'", "no 'bufer' in stations.pack"]


def test_a_study_may_be_meant_for_one_of_the_variants(tmp_path):
    with_cai = ("layout.places.bench: [6 m, 1 m]", "workers.cai: {like: ana}")
    right = file_with(tmp_path, "  sweep: {vary: {workers.cai.walk: [1 m/s, 2 m/s]}}", with_cai)
    assert study_problems(right) == []
    assert study_problems(right, ["near"]) == []
    assert [one.hint for one in study_problems(right, ["base"])] == ["did you mean workers.ana.walk?"]


def test_what_decides_nothing_on_the_floor_is_no_factor(tmp_path):
    found = wrong(
        tmp_path, "  sweep: {vary: {run.seed: [1, 2], outputs: [[walked_m], []], studies.sweep.levels: [2, 3]}}"
    )
    assert [message.partition(" ")[0] for _, _, message, _ in found] == ["run.seed", "outputs", "studies.sweep.levels"]
    assert found[0][3] == "replications have other luck each: take more of them"


def test_changes_from_an_option_are_said_to_stand_there():
    (found,) = change_problems(VARIED, {"workers": {}}, origin="--vary")
    assert found.message.startswith("with workers: {}: stations.pack: task 'lift' needs a worker")
    (found,) = change_problems(VARIED, {"run.seed": -1}, origin="--vary")
    assert (found.file, found.path, found.message) == ("--vary", "run.seed", "must be at least 0, found -1")


def test_a_horizon_from_an_option_that_is_shorter_than_the_warm_up_is_said_at_the_option(tmp_path):
    warm = file_with(tmp_path, "  {}")
    with pytest.raises(ScenarioError) as caught:
        read_scenarios(warm, changes={"run.horizon": "10 min"}, origin="command line")
    (found,) = {(one.file, one.path, one.message) for one in caught.value.problems}
    assert found == ("command line", "run.horizon", "the warm-up (30 min) must end before the horizon (10 min)")


def test_a_study_decides_neither_rows_nor_figures(tmp_path):
    plain = VARIED.with_changes({}).resolved
    asked = "  sweep: {vary: {stations.pack.buffer: [1, 2]}}\n  labour: {workforces: 12}"
    studied = Varied.read(file_with(tmp_path, asked)).with_changes({}).resolved
    assert "studies" in studied
    assert decides_rows(studied) == decides_rows(plain)
    assert decides_figures(studied) == decides_figures(plain)


BLOCKS = {verb: shapes[0] for verb, shapes in keys_of(Studies).items()}
KEYS = sorted({*BLOCKS, *(key for block in BLOCKS.values() for key in keys_of(block)), "from", "to", "levels", "x"})
WORDS = [
    *KEYS,
    "throughput_per_h",
    "walked_m/ana",
    "stations.pack.buffer",
    "1 %",
    "40 s",
    "swap pack,pack",
    "ana",
    "off",
]
SCALARS = st.one_of(
    st.none(), st.booleans(), st.integers(-3, 10**12), st.floats(), st.sampled_from(WORDS), st.text(max_size=6)
)
ANYTHING = st.recursive(
    SCALARS,
    lambda inside: st.one_of(
        st.lists(inside, max_size=3),
        st.dictionaries(st.sampled_from([*KEYS, "stations.pack.buffer"]), inside, max_size=3),
    ),
    max_leaves=8,
)


@settings(max_examples=120, deadline=None)
@given(
    st.sampled_from([*BLOCKS, "swep"]),
    st.one_of(ANYTHING, st.dictionaries(st.sampled_from(KEYS), ANYTHING, max_size=4)),
)
def test_a_block_of_any_kind_is_right_or_answered_in_words(verb, block):
    try:
        check_study(VARIED.laid({f"studies.{verb}": block}))
    except ScenarioError as error:
        assert error.problems
        assert not [word for word in ("Input should", "pydantic", "Traceback") if word in str(error)]


@pytest.mark.parametrize("verb", BLOCKS)
def test_every_key_of_a_study_says_what_it_is(verb):
    lacking = [name for name, field in BLOCKS[verb].model_fields.items() if not (field.description or field.metadata)]
    assert not [name for name in lacking if name != "vary"]

"""What the fast engine does not run is said with its place in the file.

A run by either engine; the fast one is mostly a stand-in here (its own rows: tests/opsim/engine).
"""

import json

import pytest
from plans import CELL, loaded
from plans import line as line_of_run_engines
from stand_in_engine import install_rule, stand_in

from opsim.plan import compile_plan
from opsim.problems import ScenarioError
from opsim.scenario import read_scenarios
from opsim.study import engine_choice, run_scenario
from opsim.study import replication as replicating
from opsim.study.engine_choice import engine_of, engines_of
from opsim.study.intervals import read_precision
from opsim.study.results_folder import digest, engine_said
from tests.opsim.cli.calls import LINE, line

PEOPLE = """
workers: {ana: {skills: {}}}
allocation: {rule: mine}
overrides: {sorted: {flow.dispatch: yours}}
scenarios: {base: [], other: [sorted]}
"""


NONE, TEN = ({"base": n, "other": n} for n in (0, 10))


@pytest.fixture
def variants(tmp_path, monkeypatch):
    install_rule(tmp_path, monkeypatch, "opsim.dispatch", "mine")
    install_rule(tmp_path, monkeypatch, "opsim.sequencing", "yours")
    file = line(tmp_path, LINE + PEOPLE.replace("skills: {}", "skills: {saw: 1.0}"))
    return {name: (one, compile_plan(one)) for name, one in read_scenarios(file).items()}


def test_every_place_of_all_variants_is_said_at_once_and_each_once(variants, monkeypatch):
    stand_in(monkeypatch, refuses=["belts"])
    with pytest.raises(ScenarioError) as refused:
        engines_of("fast", variants, NONE)
    told = {(one.line, one.path, one.message.partition(": ")[2]) for one in refused.value.problems}
    assert told == {
        (17, "allocation.rule", "the rule 'mine' of opsim.dispatch is a plug-in in Python"),
        (18, "flow.dispatch", "the rule 'yours' of opsim.sequencing is a plug-in in Python"),
        (0, "", "belts"),
    }
    assert len(refused.value.problems) == 3 and "--engine auto" in str(refused.value)


def test_auto_takes_an_engine_for_each_variant(variants, monkeypatch):
    stand_in(monkeypatch)
    found = engines_of("auto", variants, TEN)
    assert {name: one.engine for name, one in found.items()} == {"base": "simpy", "other": "simpy"}
    assert "'mine'" in found["base"].why and found["other"].why.endswith("and 1 more")


@pytest.fixture
def shops(tmp_path, monkeypatch):
    """Two variants of which SimPy would take 3 s an hour."""
    stand_in(monkeypatch)
    monkeypatch.setattr(engine_choice, "simpy_s", lambda plan: plan.horizon_s / 1200)
    monkeypatch.setattr(engine_choice, "cores", lambda: 4)
    more = "\noverrides: {long: {run.horizon: 10 h}, short: {run.horizon: 1 h}}\nscenarios: {a: [long], b: [short]}\n"
    return {name: (one, compile_plan(one)) for name, one in read_scenarios(line(tmp_path, LINE + more)).items()}


@pytest.mark.parametrize(
    ("runs", "processes", "waited_s"),
    [
        ({"a": 1, "b": 1}, None, 33),  # one replication is done on one core
        ({"a": 1, "b": 2}, None, 33),
        ({"a": 8, "b": 4}, None, 63),
        ({"a": 8, "b": 4}, 2, 126),
        ({"a": 0, "b": 8}, None, 6),
    ],
)
def test_auto_counts_the_seconds_of_all_variants_on_the_cores_that_there_are(shops, runs, processes, waited_s):
    found = engines_of("auto", shops, runs, processes=processes)
    assert {one.engine for one in found.values()} == {"fast" if waited_s > 20 else "simpy"}
    takes = "SimPy would take" if waited_s > 20 else "it takes"
    rounded = round(waited_s, -1) if waited_s > 100 else waited_s
    assert all(f"{takes} about {rounded} s for 2 variants," in one.why for one in found.values())


def test_a_choice_stays_what_it_is(variants, monkeypatch):
    stand_in(monkeypatch)
    loaded, plan = variants["base"]
    chosen = engine_of("auto", loaded, plan)
    assert engine_of(chosen, loaded, plan) is chosen


def test_a_file_that_has_gone_leaves_what_is_wrong_without_a_place(variants, monkeypatch):
    stand_in(monkeypatch)
    loaded, plan = variants["base"]
    loaded.file.unlink()
    with pytest.raises(ScenarioError) as refused:
        engine_of("fast", loaded, plan)
    assert [one.line for one in refused.value.problems] == [0]


KEPT = ("summary.json", "kpis.parquet", "scenario.resolved.yaml", "finished.json")


def bytes_of(folder):
    return {path.name: path.read_bytes() for path in [*(folder / "events").iterdir(), *(folder / n for n in KEPT)]}


@pytest.fixture(scope="module")
def by_simpy(tmp_path_factory):
    folder = tmp_path_factory.mktemp("simpy")
    run_scenario(loaded(CELL), folder=folder, processes=1)
    return folder


def run_fast(folder, monkeypatch, **how):
    made = stand_in(monkeypatch)
    run_scenario(loaded(CELL), folder=folder, processes=1, engine="fast", **how)
    return made


def test_both_engines_write_the_same_bytes_and_the_manifest_says_which_it_was(by_simpy, tmp_path, monkeypatch):
    made = run_fast(tmp_path, monkeypatch)
    assert [replication for _, replication in made.ran] == [0, 1, 2] and bytes_of(tmp_path) == bytes_of(by_simpy)
    assert engine_said(tmp_path) == {"asked": "fast", "used": "fast", "why": "as asked"}
    assert engine_said(by_simpy) == {"asked": "simpy", "used": "simpy", "why": "which is the reference"}
    ours, theirs = (json.loads((folder / "manifest.json").read_text()) for folder in (tmp_path, by_simpy))
    assert digest(ours) == digest(theirs) and {key for key in ours if ours[key] != theirs[key]} == {"engine"}


@pytest.mark.slow
def test_the_fast_engine_itself_writes_the_same_bytes(by_simpy, tmp_path):
    run_scenario(loaded(CELL), folder=tmp_path, processes=2, engine="fast")
    assert bytes_of(tmp_path) == bytes_of(by_simpy)
    assert len(list((tmp_path / "events").iterdir())) == 3 and engine_said(tmp_path)["used"] == "fast"


def test_a_run_goes_on_with_the_other_engine_and_the_manifest_says_so(by_simpy, tmp_path, monkeypatch):
    run_scenario(loaded(CELL), folder=tmp_path, processes=1, replications=2)
    made = run_fast(tmp_path, monkeypatch)
    assert [replication for _, replication in made.ran] == [2] and bytes_of(tmp_path) == bytes_of(by_simpy)
    assert engine_said(tmp_path)["earlier"] == ["simpy"]
    run_scenario(loaded(CELL), folder=tmp_path, processes=1, replications=4)
    assert engine_said(tmp_path)["used"] == "simpy" and engine_said(tmp_path)["earlier"] == ["fast"]


def test_results_of_the_other_engine_are_taken_as_they_are(tmp_path, monkeypatch):
    run_scenario(loaded(CELL), folder=tmp_path, processes=1)
    before, told = bytes_of(tmp_path), []
    made = run_fast(tmp_path, monkeypatch, chosen=told.append)
    assert made.ran == made.asked_for == told == [] and bytes_of(tmp_path) == before
    assert engine_said(tmp_path)["used"] == "simpy"


def test_where_only_figures_are_to_be_made_nothing_is_compiled(by_simpy, tmp_path, monkeypatch):
    run_scenario(loaded(CELL), folder=tmp_path, processes=1)
    (tmp_path / "summary.json").unlink()
    made = run_fast(tmp_path, monkeypatch)
    assert made.ran == made.asked_for == [] and bytes_of(tmp_path) == bytes_of(by_simpy)
    assert engine_said(tmp_path)["used"] == "simpy"


def test_removed_rows_leave_no_word_of_who_made_them(tmp_path, monkeypatch):
    run_fast(tmp_path, monkeypatch)
    run_scenario(loaded(CELL), folder=tmp_path, processes=1, overwrite=True)
    assert "earlier" not in engine_said(tmp_path) and engine_said(tmp_path)["used"] == "simpy"


def test_it_is_compiled_before_any_process_is_started(tmp_path, monkeypatch):
    made, started = stand_in(monkeypatch), []

    def pooled(runner, left, processes, meanwhile):
        started.append((made.is_compiled, len(made.asked_for)))
        return map(runner(), left)

    monkeypatch.setattr(replicating, "pooled", pooled)
    steps, chosen = [], []

    def told(choice):
        chosen.append(choice.engine)
        return lambda *step: steps.append(step)

    run_scenario(loaded(CELL), folder=tmp_path, processes=2, engine="fast", chosen=told)
    assert started == [(True, 1)] and chosen == ["fast"] and steps[-1] == (3, 3)


def test_what_the_fast_engine_does_not_run_leaves_no_folder(tmp_path, monkeypatch):
    stand_in(monkeypatch, refuses=["belts"])
    with pytest.raises(ScenarioError, match="belts"):
        run_scenario(loaded(CELL), folder=tmp_path / "out", engine="fast")
    assert not (tmp_path / "out").exists()


def test_auto_of_little_work_is_simpy_and_the_manifest_says_why(by_simpy, tmp_path, monkeypatch):
    made = stand_in(monkeypatch)
    run_scenario(loaded(CELL), folder=tmp_path, processes=1, engine="auto")
    assert made.asked_for == [] and bytes_of(tmp_path) == bytes_of(by_simpy)
    said = engine_said(tmp_path)
    assert (said["asked"], said["used"]) == ("auto", "simpy") and "less than a second" in said["why"]


@pytest.mark.parametrize(("there", "engine"), [(0, "fast"), (2, "simpy")])
def test_auto_counts_the_replications_that_are_not_there_yet(tmp_path, monkeypatch, there, engine):
    """Of 15 s each: three are worth compiling for 20 s, the last one is not."""
    stand_in(monkeypatch)
    monkeypatch.setattr(engine_choice, "simpy_s", lambda plan: 15.0)
    if there:
        run_scenario(loaded(CELL), folder=tmp_path, processes=1, replications=there)
    run_scenario(loaded(CELL), folder=tmp_path, processes=1, engine="auto")
    assert engine_said(tmp_path)["used"] == engine


def test_auto_is_asked_again_as_a_precision_needs_more_replications(tmp_path, monkeypatch):
    """Of 1 s each: ten are not worth compiling for 20 s, the first 40 are; and so are the last twenty then."""
    made, told = stand_in(monkeypatch), []
    monkeypatch.setattr(engine_choice, "simpy_s", lambda plan: 1.0)
    short, never = (
        loaded(line_of_run_engines(1, 1, horizon="1 min", warm_up="0 s")),
        read_precision("throughput_per_h=0.01%"),
    )
    how = {"precision": [never], "replications": 50, "processes": 1, "engine": "auto"}
    run_scenario(short, folder=tmp_path, chosen=told.append, **how)
    assert [replication for _, replication in made.ran] == [*range(20, 50)]
    assert [one.engine for one in told] == ["simpy", "fast"] and "about 40 s" in told[1].why
    assert (engine_said(tmp_path)["used"], engine_said(tmp_path)["earlier"]) == ("fast", ["simpy"])

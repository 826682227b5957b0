"""A subject of the floor that somebody else adds: the one of the example plug-in, found without pip, and wrong ones."""

import pickle
from dataclasses import replace
from pathlib import Path

import pytest
from click.testing import CliRunner
from plans import answer, loaded, plan, ran

from opsim.cli import main
from opsim.engine.choice import NotFast, able_to
from opsim.engine.fast_engine import run_plan as run_fast
from opsim.engine.floor.run import run_plan
from opsim.kpi import figures
from opsim.kpi.catalogue import CATALOGUE
from opsim.laws.audit import CHECKS, BrokenLog, audit
from opsim.log import SETUP, WORK
from opsim.plugins import PluginError
from opsim.plugins.registry import installed, subjects_of
from opsim.scenario.json_schema import json_schema
from opsim.scenario.schema.subjects import scenario_model
from opsim.study.assumptions import assumptions_of, task_sources

EXAMPLE = Path(__file__).parents[2] / "examples" / "opsim_example_plugin"
OURS = dict(CATALOGUE)
ONE = """
opsim: 1
name: a press that cools
run: {horizon: 3000 s, warm_up: 600 s, seed: 3}
layout: {places: {hall: [0 m, 0 m]}}
tasks: {glue: {fixed: 40 s, automatic: true}}
stations:
  press: {at: hall, tasks: [glue], cooling: {after: 300 s, for: 90 s}}
products: {box: {route: [press]}}
release: {kind: renewal, every: {fixed: 400 s}}
outputs: [throughput_per_h, cool_downs_per_h]
"""
COOLING = "cooling: {after: 300 s, for: 90 s}"
OTHER = """
from dataclasses import dataclass
from pydantic import Field
from opsim.engine.floor.machine import step
from opsim.kpi.catalogue import LESS, FLOW, Kpi, figure
from opsim.plugins import Subject
from opsim.scenario.fields import Whole
from opsim.scenario.tree import Block
class Words(Block):
    n: Whole = Field(1, ge=1, le=9, description="how many")
@step
def created(floor, subject, job):
    {step}
def install(build, part):
    {install}
    build.hang(build.floor.created, created)
part = Subject(words=Words, help="to count", where="scenario", plan=lambda said, scenario, ranks: said.n,
    install=install, {more})
"""
GOOD = {"step": "pass", "install": "pass", "more": ""}


def forget():
    installed.cache_clear()
    scenario_model.cache_clear()
    for name in CATALOGUE.keys() - OURS.keys():
        del CATALOGUE[name]


@pytest.fixture
def install(tmp_path, monkeypatch):
    """Install a subject for this test: (folder of its module, key, entry point)."""

    def installs(folder, key, value, distribution="their-part"):
        info = tmp_path / distribution / f"{distribution.replace('-', '_')}-2.1.dist-info"
        info.mkdir(parents=True)
        (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {distribution}\nVersion: 2.1\n")
        (info / "entry_points.txt").write_text(f"[opsim.subjects]\n{key} = {value}\n")
        monkeypatch.syspath_prepend(str(folder))
        monkeypatch.syspath_prepend(str(info.parent))
        forget()

    yield installs
    monkeypatch.undo()
    forget()


@pytest.fixture
def cooling(install):
    """The subject of the example."""
    install(EXAMPLE / "src", "cooling", "opsim_example_plugin.cooling:COOLING", "opsim-example-plugin")


@pytest.fixture
def counting(install, tmp_path):
    """Install a subject of the whole scenario, with some lines changed."""

    def installs(key="counting", code=OTHER, **changed):
        module = f"counting_of_{tmp_path.name}"
        (tmp_path / f"{module}.py").write_text(code.format(**{**GOOD, **changed}))
        install(tmp_path, key, f"{module}:part")

    return installs


def begun(log, kind):
    return log.of(kind)["start_s"].tolist()


# ------------------------------------------------------------------------------------------------ what the example does
@pytest.mark.parametrize(
    ("after", "cools", "works"),
    [
        ("300 s", [400, 1200, 2000, 2800], [490, 800, 1290, 1600, 2090, 2400, 2890]),
        ("270 s", [400, 1200, 2000, 2800], [490, 800, 1290, 1600, 2090, 2400, 2890]),
        ("269 s", [400, 800, 1200, 1600, 2000, 2400, 2800], [490, 890, 1290, 1690, 2090, 2490, 2890]),
        ("400 s", [], [400, 800, 1200, 1600, 2000, 2400, 2800]),
    ],
)
def test_a_station_that_was_idle_for_longer_than_it_may_cools_down_first(after, cools, works, cooling):
    log, made = ran(ONE, ("after: 300 s", f"after: {after}"))
    assert begun(log, SETUP) == cools and begun(log, WORK) == works
    found = {(one.kpi, one.part): one.value for one in figures(log, made) if one.subject == "press"}
    inside = [at for at in cools if at >= 600]
    assert found["cool_downs_per_h", ""] == pytest.approx(len(inside) / 2400 * 3600)
    assert found["station_states", "setup"] == pytest.approx(90 * len(inside) / 2400)


JAM = "jam: {{every: {{dist: exponential, mean: {every}}}, {fate}, repair: {{dist: exponential, mean: 60 s}}}}"
AT = "tasks: [glue], "
TWO = ("route: [press]}}", "route: [press], share: 0.5}, big: {route: [press], share: 0.5, priority: 2}}")
BY_HAND = [(", automatic: true", ""), ("release:", "workers: {ana: {skills: {press: 1.1}}}\nrelease:")]
TROUBLES = {
    "it breaks down": [(AT, AT + f"breakdowns: {{{JAM.format(every='5 min', fate='by: clock, job: scrap')}}}, ")],
    "it begins anew": [(AT, AT + f"breakdowns: {{{JAM.format(every='60 s', fate='by: busy, job: restart')}}}, ")],
    "it is set up": [(AT, AT + "setup: {otherwise: 20 s, attended: false}, "), TWO],
    "it is worked by hand": BY_HAND,
    "it closes": [
        (AT, AT + "shift: day, at_close: resume, "),
        (
            "layout:",
            "shifts: {day: {from: '08:00', to: '16:00', breaks: {lunch: {at: '12:00', lasts: 30 min}}}}\nlayout:",
        ),
        ("seed: 3", "seed: 3, start: 'Mon 06:00'"),
    ],
    "jobs are blocked": [
        ("route: [press]", "route: [press, slow]"),
        ("stations:", "stations:\n  slow: {at: hall, tasks: [dry], buffer: 0}"),
        ("tasks: {", "tasks: {dry: {dist: exponential, mean: 200 s, automatic: true}, "),
        (AT, AT + "buffer_after: 1, "),
    ],
    "jobs come back": [(AT, AT + "yield: 0.8, inspect: {finds: 0.9, then: {rework: press}}, "), *BY_HAND],
}


@pytest.mark.parametrize("edits", TROUBLES.values(), ids=TROUBLES)
def test_the_law_of_the_example_holds_whatever_else_happens(edits, cooling):
    log, made = ran(
        ONE,
        ("3000 s", "20 h"),
        ("kind: renewal, every: {fixed: 400 s}", "kind: poisson, every: 250 s"),
        ("after: 300 s", "after: 120 s"),
        *edits,
    )
    assert audit(log, made) == (*CHECKS, "a station that was idle for too long cools down before its next operation")
    assert (log["kind"] == SETUP).sum() > 30


@pytest.mark.parametrize(
    ("run", "audited", "said"),
    [
        (None, "300 s", "job 0 at press: a cool-down of 0 s at 400 s, expected 90 s as the station was idle since 0 s"),
        ("200 s", "300 s", "job 1 at press: a cool-down of 90 s at 800 s, expected 0 s"),
        ("500 s", "300 s", "job 0 at press: a cool-down of 0 s at 400 s, expected 90 s"),
    ],
    ids=["no rule on the floor", "too often", "too seldom"],
)
def test_a_log_that_breaks_the_law_of_the_example_is_caught(run, audited, said, cooling):
    law = plan(ONE.replace("300 s", audited))
    log = run_plan(replace(law, subjects=()) if run is None else plan(ONE.replace("300 s", run)))
    with pytest.raises(BrokenLog, match=said):
        audit(log, law)


def test_what_the_example_assumes_stands_in_the_sheet_and_its_task_in_the_table_of_tasks(cooling):
    of, made = loaded(ONE), plan(ONE)
    assert [words for topic, words in assumptions_of(of, made) if topic == "cooling"] == [
        "press: 90 s before a job that finds it idle for longer than 300 s, without a worker; at the start it was just "
        "used; mean loads are without it"
    ]
    row = task_sources(of, made)[0]
    assert (row["task"], row["station"], row["mean_s"], row["model"]) == ("cool_down: 90 s", "press", 90, "fixed, 90 s")


# --------------------------------------------------------------------------------------------------------------- words
WRONG = {
    "good": ([], ["good"]),
    "unit": ([("after: 300 s", "after: 300 kg")], ["cooling.after: '300 kg' is a mass; expected a time"]),
    "no unit": ([("after: 300 s", "after: 300")], ["cooling.after: 300 has no unit"]),
    "negative": ([("for: 90 s", "for: -90 s")], ["cooling.for: must be more than 0 s, found '-90 s'"]),
    "word": ([("cooling:", "coling:")], ["press.coling: unknown key 'coling'", "did you mean 'cooling'?"]),
    "word inside": ([("after:", "aftr:")], ["cooling.aftr: unknown key 'aftr'", "did you mean 'after'?"]),
    "missing": ([(", for: 90 s", "")], ["press.cooling: 'for' is missing", "add e.g. 'for: 90 s'"]),
    "no block": ([(COOLING, "cooling: 3 min")], ["expected a block of keys, found '3 min'", "such as {after:"]),
    "servers": ([("at: hall", "at: hall, servers: 2")], ["press.cooling: cooling is of one server, found 2"]),
    "preemption": ([("at: hall", "at: hall, preempt: resume")], ["one job after another: no batches, preemption"]),
    "figure": ([("cool_downs_per_h", "cool_down_per_h")], ["unknown output", "did you mean 'cool_downs_per_h'?"]),
    "two at once": (
        [("after: 300 s", "after: 300 kg"), ("products:", "product:")],
        ["is a mass", "did you mean 'products'?", "2 problems"],
    ),
}  # fmt: skip


@pytest.mark.parametrize(("edits", "said"), WRONG.values(), ids=WRONG)
def test_every_mistake_in_the_words_of_the_example_is_said_at_its_place(edits, said, cooling):
    found = answer(ONE, *edits)
    assert [words for words in said if words not in found] == [], found


def test_without_the_package_nobody_knows_its_words():
    found = answer(ONE)
    assert "stations.press.cooling: unknown key 'cooling'" in found
    assert "no installed package knows this word; keys here: at, at_close, batch" in found


def test_words_may_be_changed_by_overrides_and_asked_for_where_only_a_variant_has_them(cooling):
    bare = ONE.replace(f", {COOLING}", "")
    cools, longer = "{stations.press.cooling: {after: 10 s, for: 5 s}}", "{stations.press.cooling.for: 8 s}"
    text = (
        f"{bare}overrides: {{cools: {cools}, longer: {longer}}}\n"
        + "scenarios: {base: [], cools: [cools], longer: [cools, longer]}\n"
    )
    assert plan(text).subjects == ()
    assert loaded(text, "longer").scenario.stations["press"].cooling.for_s == 8.0
    found = answer(text.replace("cooling.for", "coling.for"))
    assert "no 'coling' in stations.press" in found and "did you mean stations.press.cooling.for?" in found


def test_the_schema_has_the_words_and_figures_of_what_is_installed_and_of_nothing_else(cooling):
    schema = json_schema()
    assert schema["definitions"]["Station"]["properties"]["cooling"]["$ref"] == "#/definitions/Cooling"
    words = schema["definitions"]["Cooling"]
    assert words["required"] == ["after", "for"] and words["additionalProperties"] is False
    assert "idle for longer than this" in words["properties"]["after"]["description"]
    assert "cool_downs_per_h" in schema["properties"]["outputs"]["items"]["enum"]


def test_the_schema_without_it_has_nothing_of_it(install):
    forget()
    assert "cooling" not in str(json_schema())


def test_a_scenario_with_such_words_goes_to_other_processes(cooling):
    of = loaded(ONE)
    assert pickle.loads(pickle.dumps(of)) == of
    assert pickle.loads(pickle.dumps(plan(ONE))).subjects == plan(ONE).subjects


# -------------------------------------------------------------------------------------------------------- engines, runs
def test_only_simpy_runs_it_and_says_so(cooling):
    made, said = plan(ONE), "the subject 'cooling' of opsim.subjects is a plug-in in Python"
    assert able_to("auto", made).words == f"the SimPy engine, as the fast one does not run this: {said}"
    with pytest.raises(NotFast, match=said):
        able_to("fast", made)
    with pytest.raises(NotImplementedError, match=said):
        run_fast(made, 0)


def test_a_floor_that_does_not_name_it_has_the_rows_it_had(cooling):
    bare = plan(ONE.replace(f", {COOLING}", "").replace(", cool_downs_per_h", ""))
    assert bare.subjects == () and able_to("auto", bare).engine == "fast"
    assert audit(run_plan(bare), bare) == CHECKS


def rows(folder):
    return {path.name: path.read_bytes() for path in sorted(folder.rglob("replication_*"))}


def glued(folder, *words):
    """What is said of a run of the example's scenario, two hours of its base, into a folder."""
    shorter = (EXAMPLE / "glue_station.yaml").read_text().replace("8 h, replications: 4", "2 h, replications: 3")
    file = folder.parent / "glue.yaml"
    file.write_text(shorter.replace("slow_to_dry: [slow_to_dry]", ""))
    done = CliRunner().invoke(main, ["run", str(file), "-o", str(folder), *words])
    assert done.exit_code == 0, done.output
    return done.output


def test_rows_are_the_same_whole_or_resumed(cooling, tmp_path):
    assert "Cool-downs of the station" in glued(tmp_path / "one", "--processes", "1")
    assert '<section id="cooling"' in (tmp_path / "one" / "base" / "report.html").read_text()
    glued(tmp_path / "on", "--processes", "1", "--replications", "2")
    before = rows(tmp_path / "on" / "base")
    assert len(before) == 2 and before.items() <= rows(tmp_path / "one" / "base").items()
    glued(tmp_path / "on")
    assert rows(tmp_path / "on") == rows(tmp_path / "one")


@pytest.mark.slow
def test_rows_are_the_same_from_one_process_or_two(cooling, tmp_path):
    for n in ("1", "2"):
        glued(tmp_path / n, "--processes", n)
    assert rows(tmp_path / "1") == rows(tmp_path / "2") and len(rows(tmp_path / "1")) == 3


# ------------------------------------------------------------------------------------------------------ somebody else's
COUNTED = ONE.replace(f", {COOLING}", "").replace(", cool_downs_per_h", "") + "counting: {n: 4}\n"


def test_a_subject_may_stand_at_the_top_of_a_scenario(counting):
    counting(
        step="floor.env  # a step sees the floor",
        more="""
    kpis=(Kpi("counted", "Counted", "1", LESS, FLOW),),
    figures=lambda log, plan, n: [figure("counted", "", "", n)],
    laws={"n is 4": lambda log, plan, n: [] if n == 4 else [f"n is {n}"]},""",
    )
    log, made = ran(COUNTED)
    assert [one.value for one in figures(log, made) if one.kpi == "counted"] == [4.0]
    with pytest.raises(BrokenLog, match="n is 5"):
        audit(log, plan(COUNTED.replace("n: 4", "n: 5")))
    assert "counting.n: must be at most 9, found 12" in answer(COUNTED, ("n: 4", "n: 12"))
    assert "unknown key 'countin'" in answer(COUNTED, ("counting:", "countin:"))


FAULTS = {
    "import": ({"code": "1 / 0\n"}, "cannot be imported: ZeroDivisionError"),
    "no subject": ({"code": "part = 3\n"}, "expected a Subject whose words are a Block, found 3, a int"),
    "key of ours": ({"key": "workers"}, "no key of a scenario can be called 'workers'"),
    "figure of ours": (
        {"more": 'kpis=(Kpi("walked_m", "Walked", "m", LESS, FLOW),)'},
        "figures of ours are called walked_m",
    ),
    "task without a colon": (
        {"more": 'tasks=lambda said: {"glue": {"fixed": "3 s"}}'},
        "the name of the task 'glue' has no colon",
    ),
    "no task": ({"more": 'tasks=lambda said: {"a: b": {"fixed": "3 kg"}}'}, "the task 'a: b': ValidationError"),
    "plan": ({"more": "mistakes=lambda said, scenario: 1 / 0"}, "failed in mistakes: ZeroDivisionError"),
    "install": ({"install": "1 / 0"}, "failed in install: ZeroDivisionError"),
    "step": ({"step": "1 / 0"}, "failed on the floor: ZeroDivisionError"),
    "section": (
        {"more": "sections=(lambda material, part: 1 / 0,)"},
        "failed in a section of the report: ZeroDivisionError",
    ),
    "law": (
        {"more": 'laws={"no": lambda log, plan, part: (1 / 0 for _ in "a")}'},
        "failed in a law: ZeroDivisionError",
    ),
}


@pytest.mark.parametrize(("changed", "said"), FAULTS.values(), ids=FAULTS)
def test_a_subject_that_is_wrong_is_named_with_its_distribution(changed, said, counting):
    counting(**changed)
    key = changed.get("key", "counting")
    with pytest.raises(PluginError) as caught:
        log, made = ran(COUNTED.replace("counting", key))
        for subject, part in subjects_of(made):
            [make(log, part) for make in subject.sections]
    assert said in str(caught.value)
    assert str(caught.value).startswith(f"plug-in {key!r} of their-part 2.1: ")
    assert f"entry point opsim.subjects: {key} = " in str(caught.value)


def test_two_subjects_with_one_figure_are_told_apart_before_anything_runs(cooling, counting):
    counting(more='kpis=(Kpi("cool_downs_per_h", "Others", "1/h", LESS, FLOW),)')
    with pytest.raises(PluginError, match=r"counting.*the figure cool_downs_per_h is one of the subject 'cooling' too"):
        ran(COUNTED)


@pytest.mark.parametrize("changed", [{"code": "1 / 0\n"}, {"key": "workers"}], ids=["import", "key"])
def test_a_subject_that_is_wrong_is_in_nobodys_way_who_does_not_use_it(changed, counting):
    counting(**changed)
    assert audit(*ran(COUNTED.replace("counting: {n: 4}\n", ""))) == CHECKS

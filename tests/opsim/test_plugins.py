"""Plug-ins made on the spot; the example plug-in, installed, is in ``test_example_plugin.py``."""

import tomllib
from pathlib import Path

import numpy as np
import pytest
import simpy
from made.shops import begun, ran

from opsim import Worker
from opsim.engine.rules import ALLOCATION_RULES
from opsim.plugins import NoSuchPlugin, PluginError, dispatch_rule, plugin_model, plugin_problems, plugins, rule_of
from opsim.plugins.registry import RULES
from opsim.scenario.schema import DISTRIBUTIONS
from opsim.tasks import Lognormal

RULE = "def first(n_waiting, oldest_since_s, walk_s, rating, station_rank, worker_rank):\n"
MODEL = """
import numpy as np
class Times:
    skeleton = None
    def __init__(self, duration_s):
        self.duration_s, self.mark_s, self.scores = duration_s, np.empty((len(duration_s), 0)), None
class Model:
    def __init__(self, reach_m, grasp="1A"):
        {init}
        self.reach_m = reach_m
    def mean_duration_s(self, worker=None):
        return {mean}
    def draw_worker(self, rng, body=None):
        {draw}
    def sample(self, n, rng, *, worker=None, condition=None):
        return Times({sample})
"""
GOOD = {"init": "pass", "mean": "2.0", "draw": "return None", "sample": "np.full(n, 2.0)"}


@pytest.fixture
def install(tmp_path, monkeypatch):
    """Install a distribution of one module and one entry point, for this test."""

    def installed(group, code, name="part", *, attribute="first", distribution="their-part", module=None):
        module = module or f"{distribution.replace('-', '_')}_of_{tmp_path.name}"
        folder = tmp_path / distribution
        info = folder / f"{distribution.replace('-', '_')}-2.1.dist-info"
        info.mkdir(parents=True)
        (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {distribution}\nVersion: 2.1\n")
        (info / "entry_points.txt").write_text(f"[{group}]\n{name} = {module}:{attribute}\n")
        if code is not None:
            (folder / f"{module}.py").write_text(code)
        monkeypatch.syspath_prepend(str(folder))
        return folder / f"{module}.py"

    return installed


@pytest.fixture
def model(install):
    """Install an emulator with some lines changed."""

    def installed(**changed):
        return install("opsim.emulators", MODEL.format(**{**GOOD, **changed}), "grab", attribute="Model")

    return installed


# ----------------------------------------------------------------------------------------------------------------- door
def test_our_own_parts_come_in_by_the_same_door():
    rules, emulators = plugins("opsim.dispatch"), plugins("opsim.emulators")
    assert {name: rules[name] for name in rules if rules.found(name).is_ours} == ALLOCATION_RULES
    assert emulators["lognormal"](mean_s=20.0, cv=0.3) == Lognormal(20.0, 0.3)
    assert all(callable(emulators[name]) for name in emulators if emulators.found(name).is_ours)


OURS = {
    "opsim.emulators": {
        **{name: f"opsim.tasks:{kind.__name__}" for name, kind in DISTRIBUTIONS.items()},
        **{"fixed": "opsim.tasks:Fixed", "recorded": "opsim.tasks:Recorded"},
    },
    **{group: {name: f"opsim.engine.rules:{rule.__name__}" for name, rule in RULES[group].items()} for group in RULES},
}


@pytest.mark.parametrize("group", OURS)
def test_pyproject_names_every_distribution_and_rule_of_ours(group):
    project = tomllib.loads((Path(__file__).parents[2] / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert project["entry-points"][group] == OURS[group]


def test_a_plug_in_is_found_by_name_and_imported_only_when_it_is_asked_for(install):
    install("opsim.dispatch", "raise RuntimeError('imported')\n")
    found = plugins("opsim.dispatch")
    assert "part" in found and "nearest" in found
    assert str(found.found("part")).startswith("their-part 2.1 (opsim.dispatch: part = their_part_of_")
    with pytest.raises(PluginError, match="imported"):
        found["part"]


def test_groups_for_later_are_there_and_empty():
    assert len(plugins("opsim.human")) == len(plugins("opsim.stations")) == 0
    with pytest.raises(ValueError, match=r"no group 'opsim.dispach'; did you mean 'opsim.dispatch'\?"):
        plugins("opsim.dispach")


def test_an_unknown_name_is_answered_with_the_nearest():
    with pytest.raises(NoSuchPlugin, match=r"opsim.dispatch: no 'neerest'; did you mean 'nearest'\?"):
        plugins("opsim.dispatch")["neerest"]
    assert plugins("opsim.dispatch").get("neerest") is None
    with pytest.raises(NoSuchPlugin, match="none installed"):
        plugins("opsim.human")["fatigue"]


def test_two_plug_ins_of_one_name_are_both_said_where_the_name_is_used(install):
    install("opsim.dispatch", RULE + "    return (walk_s,)\n", "same", distribution="one-part")
    install("opsim.dispatch", RULE + "    return (walk_s,)\n", "same", distribution="other-part")
    found = plugins("opsim.dispatch")
    assert found["nearest"] is ALLOCATION_RULES["nearest"]
    with pytest.raises(PluginError, match=r"'same' is the name of several(.|\n)*one-part 2.1(.|\n)*other-part 2.1"):
        found["same"]


# ---------------------------------------------------------------------------------------------------------------- rules
def test_a_rule_of_a_plug_in_is_called_as_ours_are(install):
    install("opsim.dispatch", RULE + "    return (-rating, walk_s, station_rank, worker_rank)\n")
    assert dispatch_rule("part")(3, 10.0, 2.0, 1.1, 0, 4) == (-1.1, 2.0, 0, 4)
    assert dispatch_rule("nearest") is ALLOCATION_RULES["nearest"]


WRONG_RULES = {
    "raise ImportError('no numbers')\n": "cannot be imported: ImportError: no numbers",
    "import no_such_thing\n": "cannot be imported: ModuleNotFoundError: No module named 'no_such_thing'",
    "def first(:\n": "cannot be imported: SyntaxError",
    "import sys; sys.exit(3)\n": "cannot be imported: SystemExit: 3",
    "last = 1\n": "cannot be imported: AttributeError: module .* has no attribute 'first'",
    "first = 1\n": "expected something to call, found 1, a int",
    "def first(n_waiting, walk_s):\n    return ()\n": r"first takes \(n_waiting, walk_s\), expected \(n_waiting, old",
    RULE + "    return (1 / walk_s,)\n": "failed as it chose: ZeroDivisionError: float division by zero",
    RULE + "    return walk_s\n": "expected a key, a tuple of one or more numbers, found 0.0",
    RULE + "    return (walk_s * float('nan'),)\n": r"a tuple of one or more numbers, found \(nan,\)",
    RULE + "    return ()\n": r"a tuple of one or more numbers, found \(\)",
}


@pytest.mark.parametrize("code", WRONG_RULES)
def test_a_wrong_rule_is_its_own_mistake_with_distribution_entry_point_file_and_exception(code, install):
    file = install("opsim.dispatch", code)
    with pytest.raises(PluginError, match=WRONG_RULES[code]) as caught:
        dispatch_rule("part")(3, 10.0, 0.0, 1.1, 0, 4)
    said = str(caught.value)
    assert said.startswith("plug-in 'part' of their-part 2.1: ")
    assert f"entry point opsim.dispatch: part = {file.stem}:first" in said and str(file) in said


def test_a_module_that_is_not_there_is_named(install):
    install("opsim.dispatch", None, module="never_written")
    with pytest.raises(PluginError, match="No module named 'never_written'"):
        dispatch_rule("part")


def test_the_line_that_failed_is_shown(install):
    file = install("opsim.dispatch", RULE + "    return (1 / walk_s,)\n")
    with pytest.raises(PluginError) as caught:
        dispatch_rule("part")(3, 10.0, 0.0, 1.1, 0, 4)
    assert f"{file}:2: return (1 / walk_s,)" in str(caught.value)


def test_ctrl_c_is_nobody_s_mistake(install):
    install("opsim.dispatch", RULE + "    raise KeyboardInterrupt\n")
    with pytest.raises(KeyboardInterrupt):
        dispatch_rule("part")(3, 10.0, 0.0, 1.1, 0, 4)


# ------------------------------------------------------------------------------------------------------------ emulators
def test_an_emulator_of_a_plug_in_works_for_a_worker(model):
    model()
    env = simpy.Environment()
    grab = plugins("opsim.emulators")["grab"](reach_m=0.4)
    assert env.run(Worker(env, "ana", {"grab": grab}).perform("grab")).end_s == 2.0
    assert grab.reach_m == 0.4 and grab.mean_duration_s() == 2.0


@pytest.mark.parametrize(
    ("changed", "said"),
    [
        ({"init": "1 / 0"}, "failed as it was set up: ZeroDivisionError"),
        ({"mean": "-2.0"}, "mean_duration_s gave -2, expected a positive number of seconds"),
        ({"mean": "None"}, "failed in mean_duration_s: TypeError"),
        ({"draw": "raise KeyError('body')"}, "failed in draw_worker: KeyError: 'body'"),
        ({"sample": "np.full(n + 1, 2.0)"}, r"sample gave durations \(65,\) and marks \(65, 0\), expected \(64,\)"),
        ({"sample": "np.full(n, -1.0)"}, "sample gave a duration of -1 s, expected positive numbers"),
        ({"sample": "np.full(n, np.nan)"}, "sample gave a duration of nan s"),
        ({"sample": "rng.no_such()"}, "failed as it drew 64 performances: AttributeError"),
        ({"sample": "[]) if n < 0 else int('x'"}, "failed as it drew 64 performances: ValueError: invalid literal"),
    ],
)
def test_an_emulator_that_fails_is_its_own_mistake(changed, said, model):
    file = model(**changed)
    env = simpy.Environment()
    with pytest.raises(PluginError, match=said) as caught:
        grab = plugins("opsim.emulators")["grab"](reach_m=0.4)
        grab.mean_duration_s()
        Worker(env, "ana", {"grab": grab}).perform("grab")
    assert "'grab' of their-part 2.1" in str(caught.value) and str(file) in str(caught.value)


def test_simpy_hands_on_whose_mistake_it_was(model):
    model(sample="1 / 0")
    env = simpy.Environment()
    ana = Worker(env, "ana", {"grab": plugins("opsim.emulators")["grab"](reach_m=0.4)})

    def story():
        yield env.timeout(1.0)
        yield ana.perform("grab")

    env.process(story())
    with pytest.raises(PluginError, match=r"'grab' of their-part 2.1: failed as it drew 64 performances"):
        env.run()


@pytest.mark.parametrize(
    ("code", "said"),
    [
        ("def first():\n    return 12.0\n", "expected a TaskModel with mean_duration_s, found 12.0, a float"),
        (
            MODEL.format(**GOOD).replace("n, rng, *, worker=None, condition=None", "n")
            + "first = lambda: Model(1.0)\n",
            r"sample takes \(n\), expected \(n, rng, \*, worker=None, condition=None\)",
        ),
    ],
)
def test_what_is_no_task_model_is_refused_when_it_is_made(code, said, install):
    install("opsim.emulators", code)
    with pytest.raises(PluginError, match=said):
        plugins("opsim.emulators")["part"]()


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({}, "missing a required argument: 'reach_m'"),
        ({"reach_m": 0.4, "grip": "1A"}, "unexpected keyword argument 'grip'"),
        ({"reach_m": -1.0}, "plug-in grab: too near"),
    ],
)
def test_what_the_caller_gives_wrongly_is_not_the_plug_in_s_mistake(given, said, model):
    model(init="\n        if reach_m < 0:\n            raise ValueError('too near')")
    with pytest.raises(ValueError, match=said) as caught:
        plugins("opsim.emulators")["grab"](**given)
    assert not isinstance(caught.value, PluginError)


# -------------------------------------------------------------------------------------------------- as a scenario says
def test_a_scenario_says_quantities_with_their_units(model):
    model()
    grab = plugin_model("grab", {"reach": "40 cm", "grasp": "4B"})
    assert grab.reach_m == 0.4 and plugin_problems("grab", {"reach": "40 cm"}) == []


@pytest.mark.parametrize(
    ("said", "problems"),
    [
        ({}, [("plugin", "needs 'reach'", "a length")]),
        ({"reach": 0.4}, [("reach", "0.4 has no unit; expected a length", None)]),
        (
            {"reech": "4 m", "reach": "4 kg"},
            [("reech", "no parameter 'reech'", "did you mean 'reach'?"), ("reach", None, None)],
        ),
        ({"reach": "-1 m"}, [("plugin", "plug-in grab: too near", "")]),
    ],
)
def test_every_mistake_in_what_a_scenario_says_is_found_with_its_key(said, problems, model):
    model(init="\n        if reach_m < 0:\n            raise ValueError('too near')")
    found = plugin_problems("grab", said)
    assert [key for key, _, _ in found] == [key for key, _, _ in problems]
    for (_, message, hint), (_, expected, nearest) in zip(found, problems):
        assert expected in (None, message) and nearest in (None, hint)
    with pytest.raises(ValueError, match=r"grab|needs|unit|reech"):
        plugin_model("grab", said)


def test_the_problems_of_a_plug_in_that_is_missing_or_broken_are_said_too(model):
    assert plugin_problems("grub", {}) == [("plugin", "no plug-in 'grub'", plugin_problems("grub", {})[0][2])]
    model(mean="1 / 0")
    ((key, message, _),) = plugin_problems("grab", {"reach": "40 cm"})
    assert key == "plugin" and "their-part 2.1: failed in mean_duration_s: ZeroDivisionError" in message


# ------------------------------------------------------------------------------------------------------------- stations
def test_a_station_of_a_plug_in_is_a_block_of_the_language(install):
    install("opsim.stations", "def first(at, servers=1):\n    return {'at': at, 'servers': servers, 'tasks': ['x']}\n")
    assert plugins("opsim.stations")["part"](at="bench") == {"at": "bench", "servers": 1, "tasks": ["x"]}


def test_a_station_that_is_no_block_is_the_plug_in_s_mistake(install):
    install("opsim.stations", "def first():\n    return [1, 2]\n")
    with pytest.raises(PluginError, match="expected the block of a station, a mapping, found a list of 2, a list"):
        plugins("opsim.stations")["part"]()


def test_a_trace_of_a_plug_in_is_still_a_trace(install):
    lines = MODEL.format(**GOOD) + "    by_index = True\n    def at(self, k):\n        return k + 1.0\n"
    install("opsim.emulators", lines, "grab", attribute="Model")
    grab = plugins("opsim.emulators")["grab"](reach_m=0.4)
    assert grab.by_index and np.array_equal(grab.at(np.arange(3)), [1.0, 2.0, 3.0])


OF_JOBS = "def first(now_s, since_s, work_s, left_s, left_steps, due_s, setup_s, number):\n"
OF_STATIONS = "def first(n_inside, servers, station_rank, n_free, mean_s, setup_s, distance_m, position):\n"


@pytest.mark.parametrize(("group", "code", "key"), [
    ("opsim.sequencing", OF_JOBS + "    return (-since_s, number)\n", (-1.0, 7.0)),
    ("opsim.routing", OF_STATIONS + "    return (-position, station_rank)\n", (-7.0, 2.0)),
])  # fmt: skip
def test_rules_of_jobs_and_of_stations_come_in_by_their_own_groups(group, code, key, install):
    install(group, code)
    assert rule_of(group, "part")(*(float(n) for n in range(8))) == key


@pytest.mark.parametrize("group", ["opsim.sequencing", "opsim.routing"])
def test_they_are_guarded_as_those_of_allocation_are(group, install):
    install(group, RULE + "    return (walk_s,)\n")
    with pytest.raises(PluginError, match=r"first takes \(n_waiting, .*expected \(n"):
        rule_of(group, "part")


def test_a_scenario_may_name_a_rule_of_a_plug_in(install, tmp_path):
    """Last come, first served."""
    install("opsim.sequencing", OF_JOBS + "    return (-since_s, number)\n", name="lifo")
    text = """
tasks: {cut: {fixed: 10 s, automatic: true}}
stations: {saw: {at: hall, tasks: [cut], dispatch: lifo}}
products: {a: {route: [saw]}, b: {route: [saw]}, c: {route: [saw]}}
"""
    assert begun(ran(tmp_path, text, "0,a 1,a 2,b 3,c")) == "acba"

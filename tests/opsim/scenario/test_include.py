"""Files laid over each other; what is wrong is said in the file where it stands."""

import time
from pathlib import Path

import pytest

from opsim.problems import ScenarioError
from opsim.scenario import read_scenarios
from opsim.scenario.templates import without_likes
from opsim.scenario.yaml import read_tree

GOOD = (Path(__file__).parent / "good.yaml").read_text(encoding="utf-8")


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)

    def write(**files):
        for name, text in files.items():
            path = Path(name.replace("__", "/") + ".yaml")
            path.parent.mkdir(exist_ok=True)
            path.write_text(text, encoding="utf-8")
        return Path("line.yaml")

    return write


def refused(file):
    with pytest.raises(ScenarioError) as caught:
        read_scenarios(file)
    return str(caught.value)


def test_a_file_over_what_it_includes_is_one_scenario(folder):
    common, own = GOOD.split("release:")
    file = folder(line=f"include: [common.yaml]\nrelease:{own}", common=common)
    folder(whole=GOOD)
    assert read_scenarios(file)["near"].scenario == read_scenarios("whole.yaml")["near"].scenario
    assert "include" not in read_scenarios(file)["base"].resolved


def test_the_later_of_two_wins_and_the_file_over_all(folder):
    file = folder(
        line=f"include: [one.yaml, two.yaml]\n{GOOD}",
        one="workers: {ana: {walk: 1 m/s, mass: 60 kg}, ben: {walk: 1 m/s}}\n",
        two="workers: {ana: {walk: 2 m/s, height: 1.8 m}}\n",
    )
    workers = read_scenarios(file)["base"].scenario.workers
    assert (workers["ana"].walk_m_per_s, workers["ana"].mass_kg, workers["ana"].height_m) == (2.0, 60.0, 1.62)
    assert (workers["ben"].walk_m_per_s, workers["ben"].mass_kg) == (1.0, 60.0)


def test_an_included_file_includes_from_its_own_folder(folder):
    file = folder(
        line=f"include: people/all.yaml\n{GOOD}",
        people__all="include: [mass.yaml]\n",
        people__mass="workers: {ana: {mass: 60 kg}}\n",
    )
    assert read_scenarios(file)["base"].scenario.workers["ana"].mass_kg == 60.0


def test_a_file_named_twice_is_laid_below_twice(folder):
    file = folder(
        line=f"include: [a.yaml, b.yaml]\n{GOOD}",
        a="include: [c.yaml]\nworkers: {ana: {walk: 1 m/s}}\n",
        b="include: [c.yaml]\n",
        c="workers: {ana: {walk: 2 m/s}}\n",
    )
    assert read_scenarios(file)["base"].scenario.workers["ana"].walk_m_per_s == 2.0


def test_overrides_and_scenarios_may_be_included(folder):
    file = folder(
        line=f"include: [more.yaml]\n{GOOD}",
        more="overrides: {slow: {workers.ana.walk: 1 m/s}}\nscenarios: {calm: [slow, near]}\n",
    )
    loaded = read_scenarios(file)
    assert set(loaded) == {"calm", "base", "near"}
    assert loaded["calm"].scenario.workers["ana"].walk_m_per_s == 1.0


def test_a_task_that_says_its_time_anew_keeps_the_load_of_the_included_one(folder):
    text = GOOD.replace("{fixed: 3 s, load: 6 kg}", "{dist: uniform, low: 2 s, high: 4 s}")
    file = folder(line=f"include: [common.yaml]\n{text}", common="tasks: {lift: {fixed: 9 s, load: 6 kg}}\n")
    task = read_scenarios(file)["base"].scenario.tasks["lift"]
    assert (task.dist, task.mean_s, task.load_kg) == ("uniform", 3.0, 6.0)


def test_a_release_or_a_way_that_is_said_anew_replaces_the_included_one(folder):
    text = GOOD.replace("{kind: poisson, every: 55 s}", "{kind: saturated}")
    common = "release: {kind: poisson, every: 9 s}\nproducts: {carton: {routing: {start: pack, pack: out}}}\n"
    scenario = read_scenarios(folder(line=f"include: [common.yaml]\n{text}", common=common))["base"].scenario
    assert (scenario.release.kind, scenario.release.every) == ("saturated", None)
    assert (scenario.products["carton"].route, scenario.products["carton"].routing) == (["pack"], None)


def test_a_shipped_scenario_may_be_included(folder):
    text = "include: [serial_line.yaml]\nrun: {seed: 9}\n"
    run = read_scenarios(folder(line=text))["base"].scenario.run
    assert (run.seed, run.horizon_s) == (9, 288000.0)


def test_a_mistake_in_an_included_file_is_said_in_that_file(folder):
    file = folder(line=f"include: [common.yaml]\n{GOOD}", common="workers:\n  ana: {mass: 60}\n  cai: {like: bne}\n")
    assert refused(file) == (
        "common.yaml:2:15: workers.ana.mass: 60 has no unit; expected a mass\n"
        "     2 |   ana: {mass: 60}\n       |               ^ write '60 kg' or '60 g'\n"
        "common.yaml:3:15: workers.cai.like: no 'bne' among the workers\n"
        "     3 |   cai: {like: bne}\n       |               ^ did you mean 'ben'?\n"
        "2 problems in common.yaml"
    )


@pytest.mark.parametrize(
    ("files", "said"),
    [
        (
            {"line": "include: [comon.yaml]\n", "common": "name: x\n"},
            "line.yaml:1:11: include[0]: no file 'comon.yaml' to include\n     1 | include: [comon.yaml]\n"
            "       |           ^ did you mean 'common.yaml'?\n1 problem in line.yaml",
        ),
        (
            {"line": "include: [../common.yaml]\n" + GOOD},
            "line.yaml:1:11: include[0]: cannot include '../common.yaml': the file must lie in the scenario's folder "
            "or below it\n     1 | include: [../common.yaml]\n       |           ^ copy the file there\n"
            "1 problem in line.yaml",
        ),
        (
            {"line": "include: [/etc/passwd, 3]\n" + GOOD},
            "line.yaml:1:11: include[0]: cannot include '/etc/passwd': the file must lie in the scenario's folder or "
            "below it\n     1 | include: [/etc/passwd, 3]\n       |           ^ copy the file there\n"
            "line.yaml:1:24: include[1]: expected the name of a file, found 3\n     1 | include: [/etc/passwd, 3]\n"
            "       |                        ^ such as [common.yaml]\n2 problems in line.yaml",
        ),
        (
            {"line": "include: [a.yaml]\n" + GOOD, "a": "include: [b.yaml]\n", "b": "include: [a.yaml]\n"},
            "b.yaml:1:11: include[0]: this goes round in a circle: a.yaml includes b.yaml includes a.yaml\n"
            "     1 | include: [a.yaml]\n       |           ^\n1 problem in b.yaml",
        ),
        (
            {"line": "include: [line.yaml]\n" + GOOD},
            "line.yaml:1:11: include[0]: this goes round in a circle: line.yaml includes line.yaml\n"
            "     1 | include: [line.yaml]\n       |           ^\n1 problem in line.yaml",
        ),
        (
            {"line": "include: [a.yaml]\n" + GOOD, "a": "- 1\n"},
            "a.yaml:1:1: expected a part of a scenario, found a list of 1\n     1 | - 1\n       | ^\n"
            "1 problem in a.yaml",
        ),
        (
            {"line": "include: [a.yaml, b.yaml]\n" + GOOD, "a": "x: {a: 1\n", "b": ""},
            "a.yaml:2:1: not YAML: the block begun with '{' does not end (it begins on line 1)\n     2 | \n"
            "       | ^ is a ',' or '}' missing?\nb.yaml: the file is empty\n"
            "  a scenario begins with 'opsim: 1'\n2 problems in a.yaml, b.yaml",
        ),
        (
            {"line": "include: [a.yaml]\n" + GOOD, "a": "libraries: {moves: ../moves.npz}\n"},
            "a.yaml:1:20: libraries.moves: cannot use '../moves.npz': the file must lie in the scenario's folder "
            "or below it\n     1 | libraries: {moves: ../moves.npz}\n       |                    ^ copy the "
            "library there\n1 problem in a.yaml",
        ),
    ],
    ids=["missing", "above", "absolute", "circle", "itself", "list", "broken", "library"],
)
def test_a_wrong_include_gets_its_whole_answer(folder, files, said):
    assert refused(folder(**files)) == said


BOMB = "x0: &x0 [1,1,1,1,1,1,1,1,1,1]\n" + "".join(
    f"x{n}: &x{n} [{', '.join([f'*x{n - 1}'] * 10)}]\n" for n in range(1, 5)
)
MANY = {f"f{n}": f"include: [{', '.join(f'f{m}.yaml' for m in range(n))}]\n" for n in range(1, 20)}


@pytest.mark.parametrize(
    ("files", "said"),
    [
        ({"line": "include: [a.yaml, b.yaml, c.yaml]\n", "a": BOMB, "b": BOMB, "c": BOMB}, "more than 200,000 values"),
        ({"line": "include: [f19.yaml]\n", "f0": "name: x\n", **MANY}, "more than 100 includes"),
        ({"line": f"include: [{', '.join(['a.yaml'] * 1000)}]\n", "a": "name: x\n"}, "more than 100 includes"),
    ],
    ids=["alias bombs", "a tree of files", "one file again and again"],
)
def test_includes_without_end_are_refused_quickly(folder, files, said):
    file = folder(**files)
    start = time.process_time()
    assert said in refused(file)
    assert time.process_time() - start < 5  # a square law would take minutes


def resolved(text):
    tree, _ = read_tree(text.encode(), "x.yaml")
    tree, problems = without_likes(tree)
    return tree.plain(), [problem.message for problem in problems]


def test_like_copies_and_a_given_key_replaces_whole():
    tree, problems = resolved("workers:\n  ana: {walk: 1, skills: {a: 1, b: 1}}\n  ben: {like: ana, skills: {a: 2}}\n")
    assert tree["workers"]["ben"] == {"walk": 1, "skills": {"a": 2}}
    assert not problems


def test_like_may_come_before_what_it_copies_and_in_chains():
    chain = "".join(f"  w{n}: {{like: w{n + 1}, k{n}: {n}}}\n" for n in range(1000))
    tree, problems = resolved(f"workers:\n{chain}  w1000: {{last: 1}}\n")
    assert len(tree["workers"]["w0"]) == 1001
    assert tree["workers"]["w0"]["last"] == 1
    assert not problems


def test_a_circle_is_said_once_whoever_leads_into_it():
    _, problems = resolved("workers:\n  c: {like: a}\n  a: {like: b}\n  b: {like: a}\n")
    assert problems == ["this goes round in a circle: a is like b is like a"]


def test_oneself_is_a_circle():
    assert resolved("workers:\n  a: {like: a}\n")[1] == ["this goes round in a circle: a is like a"]


def test_defaults_stand_below_likes_and_these_below_what_is_given():
    tree, problems = resolved(
        "defaults: {workers: {walk: 1, height: 2, mass: 3}}\n"
        "workers:\n  ana: {height: 20}\n  ben: {like: ana, mass: 30}\n  cai: {}\n"
    )
    assert tree == {
        "workers": {
            "ana": {"walk": 1, "height": 20, "mass": 3},
            "ben": {"walk": 1, "height": 20, "mass": 30},
            "cai": {"walk": 1, "height": 2, "mass": 3},
        }
    }
    assert not problems


def test_a_time_that_is_given_replaces_the_whole_time_that_is_copied():
    tree, _ = resolved(
        "defaults: {tasks: {dist: gamma, cv: 0.3, repeat: 2}}\n"
        "tasks:\n  a: {mean: 1 s}\n  b: {fixed: 3 s}\n  c: {like: a, mean: 2 s}\n  d: {like: a, dist: erlang, k: 2}\n"
    )
    assert tree["tasks"] == {
        "a": {"dist": "gamma", "cv": 0.3, "repeat": 2, "mean": "1 s"},
        "b": {"repeat": 2, "fixed": "3 s"},
        "c": {"dist": "gamma", "cv": 0.3, "repeat": 2, "mean": "2 s"},
        "d": {"repeat": 2, "dist": "erlang", "k": 2},
    }


def test_likes_that_copy_without_end_are_refused():
    chain = "".join(f"  w{n}: {{like: w{n + 1}, k{n}: {n}}}\n" for n in range(3000))
    with pytest.raises(ScenarioError, match="copy more than 1,000,000 keys"):
        resolved(f"workers:\n{chain}  w3000: {{last: 1}}\n")


@pytest.mark.parametrize(
    ("defaults", "said"),
    [
        ("[1]", "expected a block of sections, found a list of 1"),
        ("{wrokers: {}}", "no defaults for 'wrokers'"),
        ("{workers: 3}", "expected a block of keys, found 3"),
        ("{workers: {like: a}}", "defaults are like nothing"),
    ],
)
def test_wrong_defaults_are_said(defaults, said):
    assert said in resolved(f"defaults: {defaults}\nworkers: {{a: {{walk: 1}}}}\n")[1]


def test_stations_tasks_and_products_have_likes_too():
    tree, _ = resolved("stations: {a: {at: x}, b: {like: a}}\ntasks: {a: {fixed: 1 s}, b: {like: a}}\n")
    assert tree["stations"]["b"] == {"at": "x"}
    assert tree["tasks"]["b"] == {"fixed": "1 s"}

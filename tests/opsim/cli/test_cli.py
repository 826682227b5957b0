"""``--engine`` of the verbs, with a stand-in for the fast engine."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import click
import pytest
from stand_in_engine import install_rule, stand_in

from opsim import __version__
from opsim.cli import main
from opsim.cli.progress import COMPILING
from tests.opsim.cli.calls import LINE, line, opsim

ROOT = Path(__file__).parents[3]


def verbs(group=main, before=()):
    """Every verb with its words, e.g. ("motion", "fit")."""
    context = click.Context(group)
    for name in group.list_commands(context):
        command = group.get_command(context, name)
        alone = not isinstance(command, click.Group)
        if not alone:
            yield from verbs(command, (*before, name))
        if alone or command.invoke_without_command:
            yield (*before, name), command


VERBS = dict(verbs())


def test_the_verbs_are_these():
    assert set(VERBS) == {
        *(("init",), ("check",), ("run",), ("compare",), ("warm-up",), ("fit",)),
        *(("sweep",), ("select",), ("labour",), ("layout",), ("long-run",), ("merge",)),
        *(("report",), ("view",), ("export",), ("sql",), ("schema",), ("effects",), ("doctor",), ("doctor", "engines")),
        *(
            ("motion", verb)
            for verb in ("import", "clean", "segment", "fit", "sample", "show", "score", "judge", "people")
        ),
    }


@pytest.mark.parametrize("words", VERBS, ids=" ".join)
def test_every_verb_is_in_the_docs(words):
    pages = (ROOT / "README.md", *(ROOT / "docs").glob("*.md"))
    assert any(f"opsim {' '.join(words)}" in page.read_text(encoding="utf-8") for page in pages)


@pytest.mark.parametrize("words", VERBS, ids=" ".join)
def test_every_verb_has_help_and_json(words):
    assert opsim(*words, "--help")[0] == 0
    assert any("--json" in option.opts for option in VERBS[words].params)


HELP = {"pydantic", "yaml", "rich"}
"""What help has no need of, and a check of a scenario has."""


@pytest.mark.parametrize(
    "words, more, said",
    [
        (["--help"], HELP, "Usage:"),
        (["run", "--help"], HELP, "Usage:"),
        (["init", "--help"], HELP, "Usage:"),
        (["doctor", "--help"], HELP, "Usage:"),
        (["motion", "fit", "--help"], HELP, "Usage:"),
        (["check", "scenarios/serial_line.yaml"], set(), "no problems found"),
    ],
)
def test_a_verb_imports_nothing_heavy_that_it_does_not_need(words, more, said):
    heavy = {"numpy", "scipy", "numba", "simpy", "matplotlib", "emulator", "jinja2", *more}
    look = (
        "import sys\nfrom opsim.cli import main\n"
        f"try:\n    main({words!r})\nexcept SystemExit:\n    pass\n"
        f"print('HEAVY', sorted({heavy!r} & set(sys.modules)))"
    )
    shown = subprocess.run([sys.executable, "-c", look], capture_output=True, text=True, check=True, cwd=ROOT).stdout
    assert "HEAVY []" in shown and said in shown


def test_a_run_loads_blas_with_one_thread(tmp_path):
    """numpy is loaded after ``threads.lean``: threads that wait for each other took a fifth of a short run."""
    words = ["run", "scenarios/queue.yaml", "--horizon", "20 h", "--replications", "1", "--processes", "1", "-o"]
    look = (
        "from opsim.cli import main\nfrom threadpoolctl import threadpool_info\n"
        f"try:\n    main({[*words, str(tmp_path)]!r})\nexcept SystemExit:\n    pass\n"
        "print('BLAS', {one['num_threads'] for one in threadpool_info() if one['user_api'] == 'blas'})"
    )
    free = {name: value for name, value in os.environ.items() if not name.endswith("_NUM_THREADS")}
    done = subprocess.run([sys.executable, "-c", look], capture_output=True, text=True, check=True, cwd=ROOT, env=free)
    assert "BLAS {1}" in done.stdout


def test_the_version_is_that_of_the_package():
    assert opsim("--version") == (0, f"opsim {__version__}\n", "")


@pytest.mark.parametrize(
    "words, said",
    [
        (["rum"], "did you mean 'run'?"),
        (["motion", "sampel"], "did you mean 'sample'?"),
        (["xyzzy"], "known: init, check, run, report, view, compare, sweep, select, labour, layout, merge, warm-up"),
        (["run"], "Missing argument 'FILE'"),
        (["run", "x.yaml", "--replications", "0"], "--replications"),
        (["run", "x.yaml", "--seed", "-1"], "--seed"),
        (["run", "x.yaml", "--nonsense"], "--nonsense"),
    ],
)
def test_a_wrong_call_is_answered_with_what_is_right(words, said):
    code, _, complaint = opsim(*words)
    assert code == 2 and said in complaint


def test_without_a_verb_the_verbs_are_shown():
    code, shown, complaint = opsim()
    assert code == 2 and "motion" in shown + complaint


def test_a_reader_that_leaves_early_gets_no_traceback():
    command = f"{sys.executable} -c 'from opsim.cli import main; main()' check serial_line --json | head -c 1"
    result = subprocess.run(command, shell=True, capture_output=True, text=True, cwd=ROOT)
    assert "Traceback" not in result.stderr and "Exception ignored" not in result.stderr


def test_help_says_where_the_shipped_scenarios_are_named():
    _, shown, _ = opsim("--help")
    assert "opsim init --list" in shown and opsim("init", "--list")[0] == 0


def test_python_m_opsim_is_the_command():
    told = subprocess.run([sys.executable, "-m", "opsim", "--help"], capture_output=True, text=True)
    assert told.returncode == 0 and told.stdout.startswith("Usage: python -m opsim")


RUNNING = ("run", "compare", "view", "long-run", "sweep", "select", "labour", "layout")
MINE = """
workers: {ana: {skills: {saw: 1.0}}}
allocation: {rule: mine}
"""
GRID = "\nstudies: {sweep: {vary: {stations.press.buffer: [2, 3]}, figures: [throughput_per_h], replications: 2}}\n"


@pytest.fixture
def mine(tmp_path, monkeypatch):
    """A scenario whose rule is a plug-in."""
    install_rule(tmp_path, monkeypatch, "opsim.dispatch", "mine")
    return line(tmp_path, LINE + MINE)


@pytest.mark.parametrize(("engine", "code"), [("fast", 2), ("auto", 0)])
def test_without_numbas_compiler_it_is_said_what_to_do(engine, code, tmp_path, monkeypatch):
    monkeypatch.setattr("numba.config.DISABLE_JIT", 1)
    found, _, said = opsim("run", line(tmp_path), "-o", tmp_path / "out", "--engine", engine, "--processes", 1)
    assert found == code and "NUMBA_DISABLE_JIT" in said
    assert ("--engine simpy runs it" in said) == (engine == "fast")


@pytest.mark.parametrize("verb", RUNNING)
def test_every_verb_that_runs_something_has_the_option_and_knows_the_nearest_word(verb, tmp_path):
    code, _, complaint = opsim(verb, line(tmp_path), "--engine", "fsat")
    assert code == 2 and "--engine" in complaint
    assert "found 'fsat', expected simpy, fast or auto; did you mean 'fast'?" in complaint


def test_no_other_verb_has_it():
    having = {name for name in main.verbs if "--engine" in opsim(name, "--help")[1].split()}
    assert having == {*RUNNING}


def test_the_fast_engine_is_refused_a_rule_in_python_with_its_place(mine, tmp_path, monkeypatch):
    stand_in(monkeypatch, refuses=["belts"])
    code, _, complaint = opsim("run", mine, "-o", tmp_path / "out", "--engine", "fast")
    assert code == 2 and not (tmp_path / "out").exists()
    assert re.search(
        r"line\.yaml:17:20: allocation\.rule: the fast engine does not run this: the rule 'mine'", complaint
    )
    assert "opsim.dispatch" in complaint and "does not run this: belts" in complaint and "--engine simpy" in complaint


VARY = ("--vary", "workers.ana.skills.packing=1,2")
ASKED = {
    "sweep": ("starter", *VARY),
    "select": ("starter", *VARY, "--indifference", "1"),
    "layout": ("starter",),
    "labour": ("staffing_luck",),
}


@pytest.mark.parametrize("verb", ASKED)
def test_a_study_is_refused_before_it_has_a_folder(verb, tmp_path, monkeypatch):
    stand_in(monkeypatch, refuses=["belts"])
    out = tmp_path / "out"
    code, _, complaint = opsim(verb, *ASKED[verb], "-o", out, "--engine", "fast")
    assert code == 2 and "does not run this: belts" in complaint and not out.exists()


def test_an_emulator_in_python_is_drawn_by_either_engine(tmp_path, monkeypatch):
    made = stand_in(monkeypatch)
    drawn = LINE.replace(
        "{fixed: 25 s, automatic: true}", "{plugin: lognormal, with: {mean: 25 s, cv: 0.3}, automatic: true}"
    )
    assert drawn != LINE
    code, _, _ = opsim("run", line(tmp_path, drawn), "-o", tmp_path / "out", "--engine", "fast")
    assert code == 0 and len(made.ran) == 2


def test_auto_says_in_one_line_which_it_takes_and_why(mine, tmp_path, monkeypatch):
    stand_in(monkeypatch)
    code, shown, said = opsim("run", mine, "-o", tmp_path / "out", "--engine", "auto", "--json")
    lines = [one for one in said.splitlines() if "engine" in one]
    assert code == 0 and len(lines) == 1 and lines[0].startswith("run base: the SimPy engine, as the fast one does not")
    engine = json.loads(shown)["results"][0]["engine"]
    assert (engine["asked"], engine["used"]) == ("auto", "simpy") and "'mine'" in engine["why"]


VARIANTS = """
overrides: {wide: {stations.press.buffer: 4}, theirs: {allocation.rule: mine}}
"""


@pytest.mark.parametrize(
    ("names", "said_by"), [("{base: [], wide: [wide]}", ["base"]), ("{base: [], wide: [wide], theirs: [theirs]}", None)]
)
def test_auto_says_once_what_is_the_same_for_all_variants(names, said_by, tmp_path, monkeypatch):
    stand_in(monkeypatch)
    install_rule(tmp_path, monkeypatch, "opsim.dispatch", "mine")
    people = MINE.replace("mine", "oldest_job")
    file = line(tmp_path, f"{LINE}{people}{VARIANTS}scenarios: {names}\n")
    code, _, said = opsim("run", file, "-o", tmp_path / "out", "--engine", "auto", "--processes", 1)
    saying = re.findall(r"^run (\w+): the SimPy engine, as", said, re.MULTILINE)
    assert code == 0 and saying == (said_by or ["base", "wide", "theirs"])


def test_the_default_says_nothing_of_engines(tmp_path):
    _, shown, said = opsim("run", line(tmp_path), "-o", tmp_path / "out", "--replications", 1)
    assert "engine" not in shown + said


def test_without_a_terminal_compiling_is_one_plain_line_before_the_first_replication(tmp_path, monkeypatch):
    stand_in(monkeypatch, parts=40)
    _, _, said = opsim("run", line(tmp_path), "-o", tmp_path / "out", "--engine", "fast")
    assert said.splitlines()[0] == f"run base: {COMPILING}" and said.count("compiling") == 1
    assert "run base: 2 of 2" in said


def test_what_is_compiled_already_is_not_told(tmp_path, monkeypatch):
    made = stand_in(monkeypatch)
    made.is_compiled = True
    _, _, said = opsim("run", line(tmp_path), "-o", tmp_path / "out", "--engine", "fast")
    assert "compiling" not in said and len(made.ran) == 2


def test_on_a_terminal_the_bar_counts_what_is_compiled(tmp_path, monkeypatch):
    stand_in(monkeypatch, parts=40)
    shown = []
    monkeypatch.setattr("opsim.cli.progress._Bar.__call__", lambda self, *told: shown.append(told))
    monkeypatch.setattr("sys.stderr.isatty", lambda: True, raising=False)
    from opsim.cli.progress import progress, telling
    from opsim.engine.choice import Choice

    with progress("run base") as report:
        told = telling("run base", report)(Choice("fast", "as asked", "fast"))
        told(12, 40)
        report(1, 20)
    assert shown == [(12, 40, COMPILING), (1, 20)]


def test_a_sweep_writes_the_same_bytes_by_either_engine_and_compiles_once(tmp_path, monkeypatch):
    made, file = stand_in(monkeypatch), line(tmp_path, LINE + GRID)
    for engine in ("simpy", "fast"):
        code, _, said = opsim("sweep", file, "-o", tmp_path / engine, "--engine", engine, "--processes", 1)
        assert code == 0 and said.count("compiling") == (engine == "fast")
    assert len(made.asked_for) == 1 and len(made.ran) == 4
    for name in ("summary.json", "sweep.html", "figures.parquet", "study.json", "answers/all.jsonl"):
        assert (tmp_path / "simpy" / name).read_bytes() == (tmp_path / "fast" / name).read_bytes()
    assert json.loads((tmp_path / "fast" / "engine.json").read_text())["used"] == {"fast": "as asked"}


def test_a_folder_of_results_is_run_by_no_engine(tmp_path, monkeypatch):
    file, out = line(tmp_path), tmp_path / "out"
    opsim("run", file, "-o", out, "--replications", 1)
    for verb in ("compare", "long-run", "view"):
        code, _, complaint = opsim(verb, out, "--engine", "fast")
        assert code == 2 and "--engine: only where a scenario FILE is run" in complaint


def test_a_file_that_is_run_first_is_run_by_the_engine_that_is_asked_for(tmp_path, monkeypatch):
    made = stand_in(monkeypatch)
    monkeypatch.chdir(tmp_path)
    for verb, *more in (("view", "--to", "1 min"), ("long-run",)):
        before = len(made.ran)
        assert opsim(verb, "starter", *more, "--engine", "fast")[0] == 0 and len(made.ran) == before + 1

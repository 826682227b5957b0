import subprocess
import sys
from pathlib import Path

import click
import pytest

from opsim import __version__
from opsim.cli import main
from tests.opsim.cli.calls import opsim

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


@pytest.mark.parametrize(
    "words", [["--help"], ["run", "--help"], ["init", "--help"], ["doctor", "--help"], ["motion", "fit", "--help"]]
)
def test_help_imports_nothing_heavy(words):
    look = (
        "import sys\nfrom opsim.cli import main\n"
        f"try:\n    main({words!r})\nexcept SystemExit:\n    pass\n"
        "heavy = {'numpy', 'scipy', 'numba', 'pydantic', 'yaml', 'simpy', 'rich', 'matplotlib', 'emulator', 'jinja2'}\n"
        "print('HEAVY', sorted(heavy & set(sys.modules)))"
    )
    shown = subprocess.run([sys.executable, "-c", look], capture_output=True, text=True, check=True, cwd=ROOT).stdout
    assert "HEAVY []" in shown and "Usage:" in shown


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

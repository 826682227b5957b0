"""What README.md and the pages of docs show is run as it stands, each page in a folder with the files it names."""

import csv
import re
import shlex
from functools import cache
from importlib import import_module
from pathlib import Path

import click
import pytest
from click.testing import CliRunner

from opsim.cli import main
from tests.browser.axe import serious
from tests.browser.chromium import browser

ROOT = Path(__file__).parent.parent
PAGES = {"README": ROOT / "README.md", **{path.stem: path for path in sorted((ROOT / "docs").glob("[a-z]*.md"))}}
BLOCKS = [
    (name, language, text)
    for name, path in PAGES.items()
    for language, text in re.findall(r"^```(\w*)\n(.*?)^```$", path.read_text("utf-8"), re.MULTILINE | re.DOTALL)
]
PYTHON = [(name, text) for name, language, text in BLOCKS if language == "python"]
COMMANDS = [
    (name, line)
    for name, language, text in BLOCKS
    if not language
    for line in text.splitlines()
    if line.startswith(("opsim ", "python -m emulator."))
]
SCENARIO = next(text for name, language, text in BLOCKS if (name, language) == ("README", "yaml"))
MAKES_A_RECORDING = re.compile(r"opsim motion sample \S+/.* -o deep_squat\.npz")


def run(line):
    """A command as it stands, in this process: one of its own would load compiled code anew."""
    words = shlex.split(line, comments=True)
    if words[0] == "opsim":
        return CliRunner().invoke(main, words[1:])
    return CliRunner().invoke(click.command()(lambda: import_module(words[2]).main(words[3:])))


def opened(chromium, path, width):
    page = chromium.new_page(viewport={"width": width, "height": 900})
    page.goto(path.as_uri())
    return page


def test_there_is_something_to_run():
    assert len(PYTHON) >= 6 and len(COMMANDS) >= 35


def python_rows():
    """A row for each block, slow where it says what a block of README.md says: fits take seconds."""
    for k, (page, text) in enumerate(PYTHON):
        marks = pytest.mark.slow if page == "motion" and "MotionEmulator.fit(motions)" in text else ()
        yield pytest.param(page, text, id=f"{page}-{k}", marks=marks)


@pytest.mark.parametrize(("page", "block"), [*python_rows()])
def test_a_python_block_runs_as_it_stands_after_the_command_that_makes_its_recording(
    page, block, tmp_path, monkeypatch
):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "two_benches.yaml").write_text(SCENARIO)
    for line in (line for name, line in COMMANDS if name == page and MAKES_A_RECORDING.match(line)):
        assert run(line).exit_code == 0
    exec(compile(block, f"a block of {page}", "exec"), {"__name__": "__main__"})


@pytest.fixture(scope="module")
def answers(tmp_path_factory):
    """Of a page: its folder, and what each command answered there, in order; compiled code is loaded once for all."""

    @cache
    def of_page(page):
        folder = tmp_path_factory.mktemp(page)
        (folder / "two_benches.yaml").write_text(SCENARIO)
        lines = [line for name, line in COMMANDS if name == page]
        with pytest.MonkeyPatch.context() as patch:
            patch.chdir(folder)
            return folder, {line: run(line) for line in lines}

    return of_page


@pytest.mark.slow
@pytest.mark.parametrize(
    ("page", "line"), COMMANDS, ids=[f"{name}: {line.partition('  #')[0].rstrip()}" for name, line in COMMANDS]
)
def test_a_command_runs_as_it_stands_after_those_above_it(page, line, answers):
    answer = answers(page)[1][line]
    assert answer.exit_code == 0, answer.output


@pytest.mark.slow
def test_all_tables_and_figures_of_the_paper_are_made(answers):
    """What ``opsim motion judge --paper`` writes; made here because it takes long."""
    folder, said = answers("motion")
    assert "judge: deep_squat: two levels" in next(one.stderr for line, one in said.items() if " --paper " in line)
    made = folder / "judged"
    assert {path.name for path in (made / "deep_squat").iterdir()} == {
        *(f"table_{n}.csv" for n in range(1, 6)),
        *(f"figure_{n}.svg" for n in (4, 5, 7, 8, 9, 10, 13, 14, 15, 16, 19)),
    }
    tables = [list(csv.reader((made / "deep_squat" / f"table_{n}.csv").open()))[1:] for n in range(1, 6)]
    assert [len(table) for table in tables] == [3, 3, 2, 6, 6]
    assert all(0 < float(p) <= 1 for row in tables[1] for p in row[1:])
    assert "Figure 19" in (made / "index.html").read_text()


@pytest.mark.slow
@pytest.mark.browser
@pytest.mark.parametrize("width", [1280, 390])
def test_no_page_that_they_write_has_a_serious_fault_for_keyboard_or_screen_reader(answers, width):
    pages = sorted(path for name in dict(COMMANDS) for path in answers(name)[0].rglob("*.html"))
    assert len(pages) >= 10
    with browser() as chromium:
        faults = {f"{path.parent.name}/{path.name}": serious(opened(chromium, path, width)) for path in pages}
    assert {name: said for name, said in faults.items() if said} == {}

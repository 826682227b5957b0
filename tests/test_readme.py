"""What README.md and the pages of docs show is run as it stands, each page in a folder with the files it names."""

import csv
import re
import shlex
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from long_take import long_take

from emulator.recordings.bvh_write import write_bvh
from emulator.synthetic.tasks import make
from opsim.cli import main
from opsim.libraries import load_library
from opsim.shipped import shipped_folder
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
    if line.startswith("opsim ")
]
SCENARIO = next(text for name, language, text in BLOCKS if (name, language) == ("README", "yaml"))


@pytest.fixture(scope="module")
def squats():
    """A small recording in the ``.npz`` form: three people, four squats each, drawn from the shipped library."""
    model = load_library(shipped_folder() / "libraries" / "public_movements.npz")["deep_squat"]
    rate_hz = 30.0
    rng = np.random.default_rng(1)
    drawn = [model.sample(4, rng, worker=model.draw_worker(rng)) for _ in range(3)]
    frames = [
        people[k].positions_m(times_s=np.arange(0, people.duration_s[k], 1 / rate_hz))[0]
        for people in drawn
        for k in range(4)
    ]
    return {
        "positions": np.concatenate(frames),
        "offsets": np.cumsum([0, *map(len, frames)]),
        "fps": rate_hz,
        "names": np.array(model.skeleton.names),
        "parents": np.array(model.skeleton.parents),
        "subject": np.repeat(["s1", "s2", "s3"], 4),
        "trial": np.arange(12),
        "cov_correct": np.ones(12),
        "ann_turn_frame": np.concatenate([people.mark_s[:, 0] * rate_hz for people in drawn]),
    }


def with_the_files(folder, squats):
    """The files that pages name: the scenario of README.md, a recording, and a long take of six reaches as BVH."""
    (folder / "two_benches.yaml").write_text(SCENARIO)
    np.savez(folder / "deep_squat.npz", **squats)
    motions = [replace(motion, mark_s=np.zeros(0)) for motion in make("reach", 1, 6)[0].motions]
    write_bvh(long_take(motions, np.random.default_rng(0))[0], folder / "take.bvh")
    return folder


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
def test_a_python_block_runs_as_it_stands(page, block, tmp_path, squats, monkeypatch):
    """In this process: one of its own would load compiled code anew for each."""
    monkeypatch.chdir(with_the_files(tmp_path, squats))
    exec(compile(block, f"a block of {page}", "exec"), {"__name__": "__main__"})


@pytest.fixture(scope="module")
def answers(tmp_path_factory, squats):
    """Of a page: its folder, and what each command answered there, in order; compiled code is loaded once for all."""

    @cache
    def of_page(page):
        folder = with_the_files(tmp_path_factory.mktemp(page), squats)
        lines = [line for name, line in COMMANDS if name == page]
        with pytest.MonkeyPatch.context() as patch:
            patch.chdir(folder)
            return folder, {line: CliRunner().invoke(main, shlex.split(line, comments=True)[1:]) for line in lines}

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

"""What README.md shows is run as it stands, in a folder that holds the files it names."""

import re
import shlex
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from long_take import long_take

from emulator.recordings.bvh_write import write_bvh
from emulator.synthetic import make
from opsim.cli import main
from opsim.libraries import load_library
from opsim.shipped import shipped_folder

README = (Path(__file__).parent.parent / "README.md").read_text(encoding="utf-8")
BLOCKS = re.findall(r"^```(\w*)\n(.*?)^```$", README, re.MULTILINE | re.DOTALL)
PYTHON = [text for language, text in BLOCKS if language == "python"]
COMMANDS = [
    line for language, text in BLOCKS if not language for line in text.splitlines() if line.startswith("opsim ")
]


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


@pytest.fixture
def folder(tmp_path, squats):
    """The files that README.md names: its own scenario, a recording, and a long take of six reaches as BVH."""
    (tmp_path / "two_benches.yaml").write_text(next(text for language, text in BLOCKS if language == "yaml"))
    np.savez(tmp_path / "deep_squat.npz", **squats)
    motions = [replace(motion, mark_s=np.zeros(0)) for motion in make("reach", 1, 6)[0].motions]
    write_bvh(long_take(motions, np.random.default_rng(0))[0], tmp_path / "take.bvh")
    return tmp_path


def test_there_is_something_to_run():
    assert len(PYTHON) >= 3 and len(COMMANDS) >= 5


@pytest.mark.parametrize("block", PYTHON, ids=range(len(PYTHON)))
def test_a_python_block_runs_as_it_stands(block, folder):
    done = subprocess.run([sys.executable, "-c", block], cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


@pytest.mark.slow
def test_the_commands_run_as_they_stand_one_after_the_other(folder, monkeypatch):
    """All in this process: what each has to load, such as compiled code, is loaded once."""
    monkeypatch.chdir(folder)
    for line in COMMANDS:
        done = CliRunner().invoke(main, shlex.split(line, comments=True)[1:])
        assert done.exit_code == 0, f"{line}\n{done.output}"

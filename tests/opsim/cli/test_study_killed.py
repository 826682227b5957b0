"""Studies whose processes are killed at any moment, and clusters whose workers are: the same bytes in the end."""

import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from tests.opsim.cli.calls import LINE, line
from tests.study_evidence.dask import answers, disturbed, hashes, two_workers, until

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[3]
STUDY = LINE.replace("horizon: 20 min, replications: 2", "horizon: 4 h, replications: 8")
STUDY += "studies: {sweep: {vary: {stations.saw.buffer: [1, 2, 4]}}}\n"
START = """
import sys
sys.path.insert(0, {root!r})
import opsim.cli.sweep
from tests.made import study as made_study
opsim.cli.sweep.command = made_study.command
from opsim.cli import main
if __name__ == "__main__":
    main()
"""


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    """(the command that runs the made study, its words, hashes of what it makes undisturbed)"""
    folder = tmp_path_factory.mktemp("study")
    (folder / "start.py").write_text(START.format(root=str(ROOT)))
    opsim, words = [sys.executable, str(folder / "start.py")], ["sweep", str(line(folder, STUDY))]
    subprocess.run([*opsim, *words, "-o", str(folder / "whole"), "--processes", "1"], check=True, capture_output=True)
    return opsim, words, hashes(folder / "whole")


def test_a_study_that_is_killed_again_and_again_comes_out_the_same(study, tmp_path):
    opsim, words, expected = study
    out, rng = tmp_path / "s", random.Random(11)
    call = [*opsim, *words, "-o", str(out), "--processes", "2"]
    for _ in range(2):
        before = answers(out)
        process = subprocess.Popen(call, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)
        until(out, before + 2, process)
        time.sleep(rng.uniform(0, 0.1))
        process.kill()
        process.wait()
        assert answers(out) >= before + 2
    subprocess.run(call, check=True, capture_output=True)
    assert hashes(out) == expected


@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_a_stop_keeps_what_is_finished_and_says_so(study, tmp_path, number, code):
    opsim, words, _ = study
    out = tmp_path / "s"
    call = [*opsim, *words, "-o", str(out), "--processes", "1", "--replications", "2000"]
    process = subprocess.Popen(call, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    until(out, 3, process)
    os.kill(process.pid, number)
    _, complaint = process.communicate(timeout=60)
    assert process.returncode == code and "Traceback" not in complaint
    assert f"finished replications are kept in {out}; the same command goes on from there" in complaint


def test_a_cluster_with_a_killed_worker_and_a_killed_client_gives_the_bytes_of_one_process(study, tmp_path):
    pytest.importorskip("distributed")
    opsim, words, expected = study
    with two_workers() as (address, workers):
        said = disturbed(words, tmp_path / "s", address, workers, opsim)
    assert hashes(tmp_path / "s") == expected, said

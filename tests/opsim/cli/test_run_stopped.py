"""Runs on two processes that are stopped or killed, as a user or a system does it."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from tests.opsim.cli.calls import LINE, line

pytestmark = [pytest.mark.slow, pytest.mark.skipif(not Path("/proc").is_dir(), reason="looks for processes in /proc")]

ROOT = Path(__file__).parents[3]
LONG = LINE.replace("horizon: 20 min, replications: 2", "horizon: 60 h, replications: 200")
SOON_S = 60.0
"""Of a busy machine."""


@pytest.fixture
def running(tmp_path):
    """A run on two processes that has finished two replications, in a process group of its own."""
    call = ["run", str(line(tmp_path, LONG)), "-o", str(tmp_path / "out"), "--processes", "2"]
    code = f"from opsim.cli import main\nif __name__ == '__main__':\n    main({call})"
    (tmp_path / "start.py").write_text(code)
    command = [sys.executable, str(tmp_path / "start.py")]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True, start_new_session=True, env=environment)
    until(lambda: len(finished(tmp_path)) >= 2)
    yield process
    process.kill()
    process.wait()


def until(holds) -> float:
    """Seconds until something holds; fails where it takes too long."""
    started = time.monotonic()
    while not holds():
        assert time.monotonic() - started < 2 * SOON_S
        time.sleep(0.02)
    return time.monotonic() - started


def finished(folder):
    return list(folder.glob("out/base/events/replication_*.parquet"))


def children(pid):
    """Processes started by ``pid`` that do the work (the one that only keeps count of semaphores left out)."""
    listed = Path(f"/proc/{pid}/task/{pid}/children").read_text().split()
    return [int(child) for child in listed if "tracker" not in Path(f"/proc/{child}/cmdline").read_text()]


def gone(pid) -> bool:
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] == "Z"
    except (FileNotFoundError, ProcessLookupError):
        return True


@pytest.mark.parametrize("times", [1, 2])
def test_control_c_stops_soon_with_130_and_no_traceback(running, tmp_path, times):
    at_work = children(running.pid)
    before = len(finished(tmp_path))
    for _ in range(times):  # a terminal sends it to the whole group
        os.killpg(running.pid, signal.SIGINT)
        time.sleep(0.05)
    _, complaint = running.communicate(timeout=SOON_S)
    assert running.returncode == 130 and "finished replications are kept" in complaint
    assert "Traceback" not in complaint and "Exception ignored" not in complaint
    assert len(at_work) == 2 and all(gone(child) for child in at_work)
    assert len(finished(tmp_path)) < before + 50  # of 200; on a busy machine the parent hears it late
    assert not list(tmp_path.glob("out/base/events/.*"))


def test_sigterm_is_as_control_c_with_143(running):
    at_work = children(running.pid)
    running.terminate()
    _, complaint = running.communicate(timeout=SOON_S)
    assert running.returncode == 143 and "finished replications are kept" in complaint
    assert all(gone(child) for child in at_work)


@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_the_fast_engine_in_one_process_stops_too(tmp_path, number, code):
    file = line(tmp_path, LINE.replace("horizon: 20 min, replications: 2", "horizon: 2000 h, replications: 2000"))
    call = ["run", str(file), "-o", str(tmp_path / "out"), "--processes", "1", "--engine", "fast"]
    command = [sys.executable, "-c", f"from opsim.cli import main; main({call})"]
    process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True, env={**os.environ, "PYTHONPATH": str(ROOT)})
    until(lambda: finished(tmp_path))
    process.send_signal(number)
    _, complaint = process.communicate(timeout=SOON_S)
    assert process.returncode == code and "finished replications are kept" in complaint
    assert "Traceback" not in complaint and "Exception ignored" not in complaint


def test_a_killed_parent_leaves_no_process_behind(running):
    at_work = children(running.pid)
    running.kill()
    running.wait()
    assert len(at_work) == 2 and until(lambda: all(gone(child) for child in at_work)) < SOON_S


def test_a_killed_process_is_said_with_what_is_kept(running):
    os.kill(children(running.pid)[0], signal.SIGKILL)
    _, complaint = running.communicate(timeout=SOON_S)
    assert running.returncode == 1 and "a process was killed" in complaint and "try --processes 1" in complaint
    assert "Traceback" not in complaint

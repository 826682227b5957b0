"""Any study on one process and on a dask scheduler with two worker processes, of which one is killed, then the client.

``PYTHONPATH=tests python -m study_evidence.dask layout scenarios/eight_station_cell.yaml --replications 10``
prints the hash of every file of results, once undisturbed and once disturbed.
"""

import hashlib
import os
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

OPSIM = (sys.executable, "-c", "from opsim.cli import main; main()")
LIVES = ("study.json", "summary.json", "figures.parquet")
WAIT_S = 120.0


@contextmanager
def two_workers() -> Iterator[tuple[str, list[int]]]:
    """(address of a scheduler, processes of its workers), which are processes of this machine."""
    from distributed import LocalCluster

    with LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None) as cluster:
        yield cluster.scheduler_address, [nanny.pid for nanny in cluster.workers.values()]


def hashes(folder: Path) -> dict[str, str]:
    """SHA-256 of every file of results by name; pages among them."""
    files = [folder / name for name in LIVES] + sorted(folder.glob("*.html"))
    return {path.name: hashlib.sha256(path.read_bytes()).hexdigest() for path in files}


def disturbed(
    words: Sequence[str], out: Path, address: str, workers: Sequence[int], opsim: Sequence[str] = OPSIM
) -> list[str]:
    """Run a study on a cluster, kill a worker, kill the client, and go on; what happened, in words."""
    call = [*opsim, *words, "-o", str(out), "--executor", f"dask:{address}"]
    client = subprocess.Popen(call, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    said = []
    try:
        said.append(f"a worker is killed with {until(out, 3, client)} answers in the journal")
        os.kill(workers[0], signal.SIGKILL)
        said.append(f"the client is killed with {until(out, answers(out) + 5, client)} answers in the journal")
    finally:
        client.kill()
        client.wait()
    before = answers(out)
    done = subprocess.run(call, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, timeout=3600)
    if done.returncode:
        raise RuntimeError(done.stderr)
    return [*said, f"the same command goes on from {before} answers to {answers(out)}"]


def answers(out: Path) -> int:
    """Whole lines in the journal of a study that may just be written, those of figures counted too."""
    path = out / "answers" / "all.jsonl"
    return path.read_bytes().count(b"\n") if path.exists() else 0


def until(out: Path, n: int, client: subprocess.Popen) -> int:
    """Wait for so many lines of the journal, or for the end of the client."""
    started = time.monotonic()
    while answers(out) < n and client.poll() is None:
        if time.monotonic() - started > WAIT_S:
            raise TimeoutError(f"{out}: {answers(out)} answers after {WAIT_S:g} s")
        time.sleep(0.01)
    return answers(out)


def main(words: Sequence[str]) -> bool:
    """Print what happened and the hashes; whether they are the same."""
    with tempfile.TemporaryDirectory() as name:
        one, many = Path(name) / "one", Path(name) / "many"
        subprocess.run([*OPSIM, *words, "-o", str(one), "--processes", "1"], stdout=subprocess.DEVNULL, check=True)
        with two_workers() as (address, workers):
            for sentence in disturbed(words, many, address, workers):
                print(sentence)
        expected, found = hashes(one), hashes(many)
    for file, value in expected.items():
        same = "same" if value == found[file] else "OTHER"
        print(f"{file:20s} one process {value[:16]}   dask {found[file][:16]}   {same}")
    return expected == found


if __name__ == "__main__":
    sys.exit(0 if main(sys.argv[1:]) else 1)

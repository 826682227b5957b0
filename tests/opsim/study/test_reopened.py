from pathlib import Path
from shutil import copy, copytree

import numpy as np
import pytest

from opsim.log_parquet import read_events
from opsim.scenario import read_scenarios
from opsim.shipped import shipped_folder
from opsim.study import run_scenario
from opsim.study.run import reopened

LIBRARY = "libraries/bench_work.npz"
TEXT = f"""
opsim: 1
name: Bench
run: {{horizon: 10 min, replications: 2, seed: 5}}
libraries: {{work: {LIBRARY}}}
layout: {{places: {{bench: [0 m, 0 m]}}}}
tasks: {{reach: {{emulator: work/reach}}}}
stations: {{bench: {{at: bench, tasks: [reach]}}}}
products: {{part: {{route: [bench]}}}}
release: {{kind: poisson, every: 20 s}}
workers: {{ana: {{skills: {{bench: 1.0}}}}}}
"""


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """A run whose library is the user's own."""
    home = tmp_path_factory.mktemp("bench")
    (home / "libraries").mkdir()
    copy(shipped_folder() / LIBRARY, home / LIBRARY)
    (home / "bench.yaml").write_text(TEXT)
    run_scenario(read_scenarios(home / "bench.yaml")["base"], folder=home / "base", processes=1, seed=11)
    return home


def test_the_plan_and_the_rows_are_those_of_the_run(made):
    again = reopened(made / "base")
    assert (again.plan.seed, again.loaded.variant, again.result.summary["seed"]) == (11, "base", 11)
    for replication in range(2):
        rows = read_events(made / "base" / "events" / f"replication_{replication:05d}.parquet")
        assert all(np.array_equal(again.log(replication)[name], rows[name], equal_nan=True) for name in rows.columns)


def test_a_replication_that_was_not_run_is_refused_with_those_there_are(made):
    with pytest.raises(ValueError, match=r"replication 2: .* holds 0 to 1"):
        reopened(made / "base").log(2)


def test_another_library_than_that_of_the_run_is_refused(made, tmp_path):
    folder = Path(copytree(made / "base", tmp_path / "base"))
    with (folder / LIBRARY).open("ab") as library:
        library.write(b"\0")
    with pytest.raises(ValueError, match="the library work has changed"):
        reopened(folder)


def test_a_folder_without_a_run_is_an_error_in_words(tmp_path):
    with pytest.raises(OSError):
        reopened(tmp_path)

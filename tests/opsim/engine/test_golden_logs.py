"""The floor writes what it wrote: ``golden_logs.txt``. A change that means to move it renews the file and says why."""

from dataclasses import replace

import golden_logs
import numpy as np
import pytest
from checked_floors import plan_of
from engine_evidence.floors import N_FLOORS, floor_text
from golden_logs import PARTS, Golden, log_of, made, moved, shipped, written

from opsim.problems import ScenarioError

EVERY = 100
SAID = "where a word, a rule or a distribution changed, `make made-floors` draws the floors anew"
FEW = [*made()[::EVERY], "shipped/pump_assembly/base"]


def test_every_shipped_variant_and_a_thousand_made_floors_are_written_down():
    assert list(written()) == [*shipped(), *made()] and len(made()) == 1000
    assert all(len(one.hashes) == len(PARTS) for one in written().values())


def test_floors_are_no_copies_of_one_another_and_all_of_them_do_something():
    found = list(written().values())
    assert len(set(found)) > 0.98 * len(found) and min(one.n_rows for one in found) > 50


def test_a_few_floors_write_what_they_wrote():
    assert [(name, said) for name, said, _ in moved(FEW)] == [], SAID


@pytest.mark.parametrize("number", range(0, N_FLOORS, EVERY // 2))
def test_a_made_floor_is_a_scenario_still(number):
    try:
        plan_of(floor_text(number))
    except ScenarioError as error:
        pytest.fail(f"{error}\n{SAID}")


@pytest.mark.slow
def test_all_floors_write_what_they_wrote():
    rest = [name for name in (*shipped(), *made()) if name not in FEW]
    assert [(name, said) for name, said, _ in moved(rest)] == []


def test_it_is_said_what_of_a_log_moved(tmp_path, monkeypatch):
    log = log_of("made/3")
    later, other = log["end_s"].copy(), log["worker"].copy()
    later[0] += 1e-5
    other[-1] += 1
    one, two = (Golden.of(replace(log, columns=log.columns | some)) for some in ({"end_s": later}, {"worker": other}))
    assert one.moved(Golden.of(log)) == "times" and two.moved(Golden.of(log)) == "people and places"
    shorter = log.where(np.arange(len(log)) < len(log) - 1)
    assert Golden.of(shorter).moved(Golden.of(log)).startswith(f"{len(log) - 1} rows became {len(log)}, times")
    later[0] += 1e-9 - 1e-5
    assert Golden.of(replace(log, columns=log.columns | {"end_s": later})).moved(Golden.of(log)) == ""
    monkeypatch.setattr(golden_logs, "FILE", tmp_path / "golden.txt")
    (tmp_path / "golden.txt").write_text(f"# heading\nmade/3 {one}\n")
    assert [(name, said) for name, said, _ in moved(["made/3", "made/4"])] == [
        ("made/3", "times"),
        ("made/4", "is new"),
    ]

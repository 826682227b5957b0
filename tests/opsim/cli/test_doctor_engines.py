"""``opsim doctor engines``, with a stand-in for the fast engine that may be wrong."""

import json

import numpy as np
import pytest
from stand_in_engine import spoilt, stand_in

from opsim.engine.endless import EndlessInstant
from opsim.log import WORK
from tests.opsim.cli.calls import LINE, line, opsim

TWO = LINE + "\noverrides: {roomy: {stations.press.buffer: 5}}\nscenarios: {base: [], roomy: [roomy]}\n"


def late(log):
    """The end of a job's work is a last bit too late, in the second replication."""
    row = int(np.flatnonzero(log["kind"] == WORK)[20])
    return log if log.replication == 0 else spoilt(log, row, "end_s", np.nextafter(log["end_s"][row], np.inf))


def test_engines_that_agree_are_told_with_their_rows_and_times(tmp_path, monkeypatch):
    stand_in(monkeypatch)
    code, shown, said = opsim("doctor", "engines", line(tmp_path, TWO), "--replications", 2)
    assert code == 0 and shown.count("the same ") == 2 and "rows in 2 replications" in shown
    assert said.count("compiling") == 1 and not (tmp_path / "results").exists()


def test_the_numbers_are_there_for_machines(tmp_path, monkeypatch):
    stand_in(monkeypatch)
    code, shown, _ = opsim("doctor", "engines", line(tmp_path, TWO), "--scenario", "roomy", "--json")
    told = json.loads(shown)
    (variant,) = told["variants"]
    assert code == 0 and told["same"] and variant["variant"] == "roomy" and variant["rows"] > 100
    assert variant["simpy_s"] > 0 and variant["fast_s"] > 0 and "difference" not in variant


def test_a_last_bit_is_found_and_shown_column_by_column_with_the_rows_around(tmp_path, monkeypatch):
    stand_in(monkeypatch, spoil=late)
    assert opsim("doctor", "engines", line(tmp_path))[0] == 0
    code, shown, _ = opsim("doctor", "engines", line(tmp_path), "--replications", 3)
    assert code == 1 and "replication 1: row " in shown and "differs in end_s" in shown
    marked = [one.split() for one in shown.splitlines() if one.rstrip().endswith("differs")]
    assert [one[0] for one in marked] == ["end_s"] and marked[0][1] != marked[0][2]
    around = shown[shown.index("the rows around it") :]
    assert around.count("both ") == 3 and around.count("simpy ") == 4 and around.count("fast ") == 4


def test_a_difference_is_there_for_machines(tmp_path, monkeypatch):
    stand_in(monkeypatch, spoil=late)
    code, shown, _ = opsim("doctor", "engines", line(tmp_path), "--replications", 3, "--json")
    told = json.loads(shown)
    differ = told["variants"][0]["difference"]
    assert code == 1 and not told["same"] and told["variants"][0]["replications"] == 2
    assert (differ["replication"], differ["columns"]) == (1, ["end_s"])
    one, other = differ["row_by_simpy_and_fast"]["end_s"]
    assert np.nextafter(float(one), np.inf) == float(other)


def test_what_differs_in_one_variant_does_not_keep_the_others_from_being_told(tmp_path, monkeypatch):
    stand_in(monkeypatch, spoil=lambda log: spoilt(log, 3, "job", 99) if len(log) % 2 else log)
    _, shown, _ = opsim("doctor", "engines", line(tmp_path, TWO), "--json")
    assert [one["variant"] for one in json.loads(shown)["variants"]] == ["base", "roomy"]


def fails(error):
    """A log that is never written."""

    def fail(log):
        raise error

    return fail


def test_an_engine_that_alone_comes_to_no_end_is_told_as_a_difference(tmp_path, monkeypatch):
    stand_in(monkeypatch, spoil=lambda log: log if log.replication == 0 else fails(ZeroDivisionError("of mine"))(log))
    code, shown, complaint = opsim("doctor", "engines", line(tmp_path, TWO), "--replications", 3)
    assert code == 1 and "compiling" in complaint and shown.count("replication 1: simpy wrote ") == 2
    assert shown.count("rows, fast ended with ZeroDivisionError: of mine") == 2
    _, shown, _ = opsim("doctor", "engines", line(tmp_path), "--replications", 3, "--json")
    told = json.loads(shown)
    assert not told["same"] and told["variants"][0]["ended"].endswith("fast ended with ZeroDivisionError: of mine")


def test_what_neither_engine_comes_to_an_end_of_is_told_as_of_any_run(tmp_path, monkeypatch):
    def endless(*_):
        raise EndlessInstant("t = 60.0 s: over 10000 rounds")

    stand_in(monkeypatch).run_plan = endless
    monkeypatch.setattr("opsim.engine.floor.run_plan", endless)
    code, _, complaint = opsim("doctor", "engines", line(tmp_path))
    assert code == 1 and "does not move on in time" in complaint and "t = 60.0 s" in complaint


def test_the_first_run_on_a_new_floor_is_compared_too(tmp_path, monkeypatch):
    """As every first replication is one; the second is quicker, and timed."""
    runs = []
    stand_in(monkeypatch, spoil=lambda log: (runs.append(1), spoilt(log, 3, "job", 99) if len(runs) == 1 else log)[1])
    code, shown, _ = opsim("doctor", "engines", line(tmp_path))
    assert code == 1 and "row 3 differs in job" in shown and len(runs) == 2


def test_what_the_fast_engine_does_not_run_is_a_mistake(tmp_path, monkeypatch):
    stand_in(monkeypatch, refuses=["belts", "kits"])
    code, _, complaint = opsim("doctor", "engines", line(tmp_path))
    assert code == 2 and "belts" in complaint and "kits" in complaint
    assert "nothing to compare" in complaint and "--engine" not in complaint


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["no_such.yaml"], "no_such.yaml"),
        (["line.yaml", "--scenario", "bsae"], "no scenario 'bsae'"),
        (["line.yaml", "--horizon", "5 kg"], "5 kg"),
        (["line.yaml", "--replications", "0"], "--replications"),
    ],
)
def test_a_wrong_call_is_answered_with_what_is_right(words, said, tmp_path, monkeypatch):
    line(tmp_path)
    monkeypatch.chdir(tmp_path)
    code, _, complaint = opsim("doctor", "engines", *words)
    assert code == 2 and said in complaint


def test_doctor_alone_is_as_it_was_and_knows_the_nearest_word():
    assert opsim("doctor")[1].endswith("all well\n")
    code, _, complaint = opsim("doctor", "engnies")
    assert code == 2 and "did you mean 'engines'?" in complaint

import json

from opsim import checkup
from tests.opsim.cli.calls import opsim


def test_all_is_well_here():
    code, shown, _ = opsim("doctor")
    assert code == 0 and shown.endswith("all well\n")


def test_what_is_wrong_is_named_and_the_exit_code_is_2(monkeypatch):
    monkeypatch.setattr(checkup, "findings", lambda: [checkup.Finding("numpy", checkup.WRONG, "not installed")])
    code, shown, _ = opsim("doctor")
    assert code == 2 and "not installed" in shown and shown.endswith("wrong: numpy\n")
    code, shown, _ = opsim("doctor", "--json")
    assert code == 2 and json.loads(shown)["well"] is False


def test_a_note_is_nothing_wrong(monkeypatch):
    monkeypatch.setattr(checkup, "findings", lambda: [checkup.Finding("output", checkup.NOTE, "ascii")])
    assert opsim("doctor")[0] == 0

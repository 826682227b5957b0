"""Rules of the floor are found in the package of the compiled engine too, with its names for those of the floor."""

import pytest

from opsim.engine.fast_engine import floor_state, lowering
from opsim.engine.fast_engine.lowering import FLOOR, rules


def test_a_rule_is_the_file_of_the_floor_and_takes_its_names_from_here():
    from opsim.engine.fast_engine import flow
    from opsim.engine.floor import flow as in_python

    assert flow.__file__ == in_python.__file__ == str(FLOOR / "flow.py")
    assert flow is not in_python and flow.Floor is floor_state.Floor is not in_python.Floor


def test_modules_with_a_form_of_their_own_are_no_rules():
    assert len(rules()) > 40
    assert not {"machine", "event_list", "keys", "human_models"} & set(rules())


@pytest.mark.parametrize("harm", [b"", b"half", None])
def test_what_is_kept_of_a_rule_is_read_where_it_is_whole_and_of_today(tmp_path, monkeypatch, harm):
    path = tmp_path / "rule.py"
    path.write_text("import opsim.engine.floor as said\nx = 1\n")
    monkeypatch.setattr(lowering, "FLOOR", tmp_path)
    monkeypatch.setattr(lowering, "HERE", tmp_path)
    monkeypatch.setattr("sys.dont_write_bytecode", False)
    before = lowering._code(path)
    (kept,) = (tmp_path / "__pycache__").iterdir()
    if harm is None:
        path.write_text("import opsim.engine.floor as said\nx = 22\n")
    else:
        kept.write_bytes(harm)
    again = lowering._code(path)
    assert (again == before) == (harm is not None) and "opsim.engine.fast_engine" in again.co_names
    assert lowering._code(path) == again

"""The table: machine code comes from disk, or is compiled once, with all that steps come to."""

import ctypes

import pytest
from made.machine import Floor, empty_floor, is_even, is_odd

from opsim.engine.fast_engine.machine import TABLE, code_cache, complete, line_of, step, table
from opsim.engine.fast_engine.machine.calling import caller
from opsim.engine.fast_engine.machine.table import lacking

even, odd = caller(is_even), caller(is_odd)


@step
def is_even_here(floor: Floor, n: int) -> bool:
    """By a step that may be compiled already."""
    return is_even(floor, n)


BY_A_LINE = line_of(is_odd)


@step
def names_a_line(floor: Floor, n: int) -> int:
    return BY_A_LINE


@pytest.fixture
def place(tmp_path, monkeypatch):
    """An empty table and an empty place on disk."""
    before = TABLE.copy()
    monkeypatch.setattr(code_cache, "folder", lambda: tmp_path / "steps-now")
    monkeypatch.setattr(code_cache, "shipped", lambda: None)
    forgotten()
    yield tmp_path / "steps-now"
    TABLE[:] = before


@pytest.fixture
def compilations(monkeypatch):
    """The names of the steps that were compiled, each time."""
    found = []

    def counted(steps, really=table.compiled):
        made = really(steps)
        found.append(sorted(table.STEPS[line].function.__name__ for line in made.steps))
        return made

    monkeypatch.setattr(table, "compiled", counted)
    return found


def forgotten():
    TABLE[[one.line for one in (is_even, is_odd, is_even_here, names_a_line)]] = 0


def answers():
    _, floor = empty_floor()
    return [even(floor.address, n) for n in range(5)]


def test_what_a_step_names_is_compiled_with_it_and_read_by_another_process(place, compilations):
    complete([is_even])
    assert compilations == [["is_even", "is_odd"]] and len(list(place.iterdir())) == 1
    forgotten()
    told = []
    complete([is_even], lambda *so_far: told.append(so_far))
    assert len(compilations) == 1 and told == []
    assert answers() == [1, 0, 1, 0, 1]


def test_a_step_is_needed_by_who_names_its_line(place, compilations):
    complete([names_a_line])
    assert compilations == [["is_even", "is_odd", "names_a_line"]]
    assert caller(names_a_line)(empty_floor()[1].address, 0) == is_odd.line


def test_what_was_compiled_before_is_called_by_the_table_and_found_with_what_calls_it(place, compilations):
    complete([is_even])
    complete([is_even_here])
    assert compilations == [["is_even", "is_odd"], ["is_even_here"]]
    forgotten()
    assert lacking([is_even_here]) == []
    complete([is_even_here])
    assert len(compilations) == 2
    assert caller(is_even_here)(empty_floor()[1].address, 8) == 1


def test_a_step_whose_callees_are_no_more_on_disk_has_them_compiled(place, compilations):
    complete([is_even])
    (kept,) = place.iterdir()
    complete([is_even_here])
    kept.unlink()
    forgotten()
    assert lacking([is_even_here]) == [is_even.line]
    complete([is_even_here])
    assert compilations[2:] == [["is_even", "is_odd"]]
    assert caller(is_even_here)(empty_floor()[1].address, 8) == 1


def test_what_is_in_the_table_is_neither_read_nor_compiled(place, compilations, monkeypatch):
    complete([is_even])
    monkeypatch.setattr(code_cache, "kept", lambda: pytest.fail("read again"))
    complete([is_even, is_odd])
    assert len(compilations) == 1 and lacking([is_odd]) == []


def test_a_file_that_was_cut_off_is_compiled_anew(place, compilations):
    complete([is_even])
    (kept,) = place.iterdir()
    kept.write_bytes(kept.read_bytes()[:-9])
    forgotten()
    complete([is_even])
    assert len(compilations) == 2 and answers() == [1, 0, 1, 0, 1]
    assert len(code_cache.kept()) == 1


def test_a_step_whose_file_has_changed_is_compiled_anew_in_the_place_of_the_old_one(place, compilations, monkeypatch):
    complete([is_even])
    forgotten()
    monkeypatch.setattr(table, "stamp_of", lambda path: "changed")
    complete([is_even])
    assert len(compilations) == 2 and len(list(place.iterdir())) == 1


def test_where_nothing_can_be_written_it_is_compiled_and_runs(place, compilations, monkeypatch):
    monkeypatch.setattr(code_cache, "folder", lambda: None)
    told = []
    complete([is_even], lambda *so_far: told.append(so_far))
    assert told == [(0, 1), (1, 1)]
    assert answers() == [1, 0, 1, 0, 1] and not place.exists()


def test_somebody_who_interrupts_it_leaves_nothing_half_done(place, compilations, monkeypatch):
    def interrupted(_text):
        raise KeyboardInterrupt

    with monkeypatch.context() as broken:
        broken.setattr(table, "machine_code", interrupted)
        with pytest.raises(KeyboardInterrupt):
            complete([is_even])
    assert not TABLE[is_even.line] and not place.exists()
    complete([is_even])
    assert answers() == [1, 0, 1, 0, 1]


@step
def fails(floor: Floor, n: int) -> int:
    if n == 0:
        raise OverflowError("so many are too many")
    return fails(floor, n - 1) // (n - 3)


@pytest.mark.parametrize(("n", "error", "words"), [(2, OverflowError, "too many"), (3, OverflowError, "so many")])
def test_what_a_step_raises_far_down_python_raises_as_it_is(place, n, error, words):
    complete([fails])
    with pytest.raises(error, match=words):
        caller(fails)(empty_floor()[1].address, n)


@step
def divides(floor: Floor, n: int) -> int:
    return 7 // n


def test_a_division_by_zero_is_pythons(place):
    complete([divides])
    _, floor = empty_floor()
    assert [caller(divides)(floor.address, n) for n in (2, -2)] == [3, -4]
    with pytest.raises(ZeroDivisionError, match="division by zero"):
        caller(divides)(floor.address, 0)


def test_every_function_of_c_that_steps_may_call_is_there():
    """LLVM would end the process where one is not."""
    found = ctypes.CDLL(None)
    assert all(hasattr(found, name) for name in ("exp", "log", "log2", "cos", "sin", "pow", "log1p", "fmod", "memset"))

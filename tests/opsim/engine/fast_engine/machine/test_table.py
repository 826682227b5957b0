"""The table: machine code comes from disk, or is compiled once; where the short way fails, numba's own is taken."""

import gc
import subprocess
import sys
from contextlib import contextmanager

import pytest
from made.machine import empty_floor, is_even, is_odd

from opsim.engine.fast_engine.machine import TABLE, code_cache, compiling, complete, needed, step_of, table
from opsim.engine.fast_engine.machine import code_cache as store
from opsim.engine.fast_engine.machine.calling import caller

STEPS = list(needed([step_of(is_even)]))
even = caller(is_even)


@pytest.fixture
def place(tmp_path, monkeypatch):
    """An empty table and an empty place on disk."""
    before = [int(TABLE[one.line]) for one in STEPS]
    forgotten()
    monkeypatch.setattr(store, "folder", lambda: tmp_path / "steps-now")
    monkeypatch.setattr(table, "folder", store.folder)
    monkeypatch.setattr(store, "shipped", lambda: None)
    yield tmp_path / "steps-now"
    for one, at in zip(STEPS, before, strict=True):
        TABLE[one.line] = at


@pytest.fixture
def compilations(monkeypatch):
    """The steps that were compiled."""
    found = []

    def counted(signature, function, really=table.compiled):
        found.append(function.__name__)
        return really(signature, function)

    monkeypatch.setattr(table, "compiled", counted)
    return found


def forgotten():
    for one in STEPS:
        TABLE[one.line] = 0


def answers():
    _, floor = empty_floor()
    return [even(floor.address, n) for n in range(5)]


def test_what_one_process_has_compiled_another_one_reads(place, compilations):
    complete(STEPS)
    assert sorted(compilations) == ["is_even", "is_odd"]
    assert len(list(place.iterdir())) == 2
    forgotten()
    told = []
    complete(STEPS, lambda *so_far: told.append(so_far))
    assert len(compilations) == 2
    assert told == []
    assert answers() == [1, 0, 1, 0, 1]


def test_what_is_in_the_table_is_neither_read_nor_compiled(place, compilations, monkeypatch):
    complete(STEPS)
    monkeypatch.setattr(table, "read", lambda path: pytest.fail("read again"))
    complete(STEPS)
    assert len(compilations) == 2


def test_a_file_that_was_cut_off_is_compiled_anew(place, compilations):
    complete(STEPS)
    broken = store.path_of(step_of(is_odd).function, step_of(is_odd).line)
    broken.write_bytes(broken.read_bytes()[:-9])
    forgotten()
    complete(STEPS)
    assert sorted(compilations) == ["is_even", "is_odd", "is_odd"]
    assert answers() == [1, 0, 1, 0, 1]
    assert store.read(broken) is not None


def test_machine_code_that_calls_what_is_not_there_is_compiled_anew(place, compilations):
    complete(STEPS)
    path = store.path_of(step_of(is_odd).function, step_of(is_odd).line)
    found = store.read(path)
    store.keep(path, store.Code(found.name, ("no_such_function_anywhere",), found.machine_code))
    forgotten()
    complete(STEPS)
    assert len(compilations) == 3
    assert answers() == [1, 0, 1, 0, 1]


def test_where_nothing_can_be_written_it_is_compiled_and_runs(place, compilations, monkeypatch):
    monkeypatch.setattr(store, "folder", lambda: None)
    monkeypatch.setattr(table, "folder", lambda: None)
    told = []
    complete(STEPS, lambda *so_far: told.append(so_far))
    assert told == [(0, 2), (1, 2), (2, 2)]
    assert answers() == [1, 0, 1, 0, 1]
    assert not place.exists()


def test_nobody_helps_where_nothing_can_be_written(place, monkeypatch):
    monkeypatch.setattr(store, "folder", lambda: None)
    monkeypatch.setattr(table, "folder", lambda: None)
    monkeypatch.setattr(table, "WORTH_HELP", 1)
    monkeypatch.setattr(table, "helped", lambda *_: pytest.fail("asked for help"))
    complete(STEPS)
    assert answers() == [1, 0, 1, 0, 1]


def test_a_process_that_helps_finds_every_step():
    """By its module, which a process that has read no plan may not have imported yet."""
    from opsim.engine.fast_engine import lowering
    from opsim.engine.fast_engine.machine import steps

    lowering.know_all()
    engine = [one for one in steps.STEPS.values() if one.function.__module__.startswith("opsim.")]
    names = "".join(f"{table._name(one)}\n" for one in engine)
    program = "from opsim.engine.fast_engine.machine import table; table.is_on_disk = lambda one: True"
    command = [sys.executable, "-c", f"import sys; {program}; table.help_out(sys.stdin)"]
    said = subprocess.run(command, input=names, capture_output=True, text=True, check=True).stdout
    assert said.count("\n") == len(engine) + 1 > 200


def test_what_others_compile_is_read_from_disk(place, compilations, monkeypatch):
    """Another process is a thread here."""

    @contextmanager
    def helped(work, _command):
        while (job := work.last()) is not None:
            table.do_elsewhere(job.name)
            work.done(job, well=True)
        yield

    monkeypatch.setattr(table, "WORTH_HELP", 1)
    monkeypatch.setattr(table, "helped", helped)
    monkeypatch.setattr(table, "_made", lambda one: pytest.fail("compiled here too"))
    complete(STEPS)
    assert sorted(compilations) == ["is_even", "is_odd"]
    assert answers() == [1, 0, 1, 0, 1]


def test_somebody_who_interrupts_it_finds_what_was_compiled_before(place, compilations, monkeypatch):
    really = table._made

    def interrupted(one):
        if compilations:
            raise KeyboardInterrupt
        return really(one)

    monkeypatch.setattr(table, "_made", interrupted)
    with pytest.raises(KeyboardInterrupt):
        complete(STEPS)
    assert gc.isenabled()
    assert [one.suffix for one in place.iterdir()] == [".step"]
    monkeypatch.setattr(table, "_made", really)
    complete(STEPS)
    assert sorted(compilations) == ["is_even", "is_odd"]
    assert answers() == [1, 0, 1, 0, 1]


def test_what_is_to_be_called_besides_is_called_and_counted(place):
    called, told = [], []
    complete(STEPS, lambda *so_far: told.append(so_far), [], [lambda: called.append("first")])
    assert called == ["first"]
    assert told == [(0, 3), (1, 3), (2, 3), (3, 3)]


class Fails:
    def compiled_step(self, signature, function):
        raise AttributeError("numba has no such thing any more")


@pytest.mark.filterwarnings("ignore::opsim.engine.fast_engine.machine.code_cache.SlowCompiling")
@pytest.mark.parametrize("less", [None, Fails()])
def test_without_numbas_inner_parts_it_compiles_as_everybody_does(place, monkeypatch, less):
    monkeypatch.setattr(compiling, "LESS", less)
    monkeypatch.setattr(compiling, "kept", lambda signature, function: compiling.numba.njit(signature)(function))
    complete(STEPS)
    assert answers() == [1, 0, 1, 0, 1]
    assert not place.exists()  # what numba makes by itself, it keeps by itself


def test_of_a_slower_way_it_is_said_once_why(place, monkeypatch):
    monkeypatch.setattr(code_cache, "_SAID", set())
    monkeypatch.setattr(compiling, "LESS", Fails())
    monkeypatch.setattr(compiling, "kept", lambda signature, function: compiling.numba.njit(signature)(function))
    with pytest.warns(code_cache.SlowCompiling, match="numba has no such thing any more") as said:
        complete(STEPS)
    assert [one.category for one in said].count(code_cache.SlowCompiling) == 1


class IsFull:
    def compiled_step(self, signature, function):
        raise MemoryError


def test_a_full_memory_is_no_reason_to_compile_again(place, monkeypatch):
    monkeypatch.setattr(compiling, "LESS", IsFull())
    with pytest.raises(MemoryError):
        complete(STEPS)


@pytest.mark.filterwarnings("ignore::opsim.engine.fast_engine.machine.code_cache.SlowCompiling")
def test_a_helper_that_needs_more_passes_gets_all_of_them():
    @compiling.inlined
    def largest(n):
        return sum([2 * i for i in range(n)])  # a list of Python's, by a closure: none of the few passes knows it

    @compiling.numba.njit
    def asked(n):
        return largest(n)

    assert asked(4) == 12

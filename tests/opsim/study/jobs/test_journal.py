import math
import os
import struct
from functools import cache

import pytest
from hypothesis import given
from hypothesis import strategies as st

from opsim.kpi.catalogue import Figure
from opsim.study.jobs.job import Answer
from opsim.study.jobs.journal import Journal

FEW = ("throughput_per_h", "walked_m")
MORE = (*FEW, "worker_states")


def answer(*values):
    names = MORE if len(values) > 2 else FEW
    return Answer.of([Figure(name, "Zoë", "", "1/h", value) for name, value in zip(names, values)])


def written(path, answers, first=0):
    journal = Journal(own=path)
    for number, one in enumerate(answers, first):
        journal.add(("point", number, -1), one)
    journal.close()


def read(path, **how):
    journal = Journal([path], **how)
    found = {address: (journal.keys(address), journal.values(address)) for address in journal}
    journal.close()
    return found, journal.damaged


def bits(values):
    return [struct.pack("d", value) if not math.isnan(value) else b"nan" for value in values]


@cache
def five(n=5):
    """The bytes of a journal of five answers of two kinds."""
    import tempfile
    from pathlib import Path

    with tempfile.TemporaryDirectory() as folder:
        written(Path(folder) / "j", [answer(k / 3, math.nan, *([k * 1e-9] if k % 2 else [])) for k in range(n)])
        return (Path(folder) / "j").read_bytes()


@given(st.lists(st.floats(), min_size=2, max_size=3))
def test_a_journal_gives_back_every_bit(tmp_path_factory, values):
    path = tmp_path_factory.mktemp("journal") / "all.jsonl"
    written(path, [answer(*values)])
    (found,) = read(path)[0].values()
    assert bits(found[1]) == bits(values) and found[0][0] == ("throughput_per_h", "Zoë", "", "1/h")


@given(st.integers(0, len(five())))
def test_a_journal_cut_anywhere_holds_the_first_answers_and_goes_on(tmp_path_factory, size):
    path = tmp_path_factory.mktemp("journal") / "all.jsonl"
    path.write_bytes(five()[:size])
    found, damaged = read(path)
    assert [address[1] for address in found] == list(range(len(found))) and not damaged
    written(path, [answer(k / 3, math.nan, *([k * 1e-9] if k % 2 else [])) for k in range(len(found), 5)], len(found))
    assert path.read_bytes() == five()


@given(st.integers(0, len(five()) - 1), st.integers(1, 255))
def test_a_damaged_line_is_said_and_costs_at_most_the_answers_that_need_it(tmp_path_factory, at, change):
    path = tmp_path_factory.mktemp("journal") / "all.jsonl"
    raw = bytearray(five())
    raw[at] ^= change
    path.write_bytes(bytes(raw))
    whole = tmp_path_factory.mktemp("journal") / "all.jsonl"
    whole.write_bytes(five())
    (found, damaged), (all_of_them, _) = read(path), read(whole)
    assert all(bits(found[address][1]) == bits(all_of_them[address][1]) for address in found)
    assert damaged or (at == len(raw) - 1 and len(found) == 4)
    assert all(place.startswith(f"{path}:") for place in damaged)


@given(st.integers(0, len(five()) - 1), st.integers(1, 255))
def test_a_damaged_line_is_said_once_and_nothing_else_is_lost_with_it(tmp_path_factory, at, change):
    folder = tmp_path_factory.mktemp("journal")
    raw = bytearray(five())
    raw[at] ^= change
    (folder / "all.jsonl").write_bytes(bytes(raw))
    readable = read(folder / "all.jsonl")[0]
    first = Journal(own=folder / "all.jsonl")
    assert {address: bits(first.values(address)) for address in first} == {a: bits(v) for a, (_, v) in readable.items()}
    assert first.damaged or at == len(raw) - 1
    for number in range(5):
        if ("point", number, -1) not in first:
            first.add(("point", number, -1), answer(number / 3, math.nan, *([number * 1e-9] if number % 2 else [])))
    first.close()
    found, damaged = read(folder / "all.jsonl")
    assert len(found) == 5 and not damaged and not list(folder.glob(".*"))


def test_a_journal_that_cannot_be_mended_is_read_as_it_is(tmp_path, monkeypatch):
    path = tmp_path / "all.jsonl"
    path.write_bytes(five().replace(b"walked_m", b"wolked_m", 1))
    before = path.read_bytes()

    def full(path):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("opsim.study.jobs.journal.whole_file", full)
    journal = Journal(own=path)
    assert journal.damaged and path.read_bytes() == before
    journal.close()


def test_another_process_still_writing_is_read_up_to_its_last_whole_line_and_left_alone(tmp_path):
    (tmp_path / "shard_1_of_2.jsonl").write_bytes(five()[:-3])
    journal = Journal([tmp_path / "shard_1_of_2.jsonl"], tmp_path / "all.jsonl")
    assert len(journal) == 4
    journal.close()
    assert (tmp_path / "shard_1_of_2.jsonl").read_bytes() == five()[:-3]


def test_other_answers_to_the_same_job_in_two_files_are_found(tmp_path):
    written(tmp_path / "a", [answer(1.0, 2.0), answer(1.0, math.nan)])
    written(tmp_path / "b", [answer(1.0, 2.5), answer(1.0, math.nan)])
    journal = Journal([tmp_path / "a", tmp_path / "b"])
    assert journal.twice == [f"{tmp_path / 'b'}:2"]
    journal.close()


def test_a_full_disk_leaves_the_journal_as_it_was(tmp_path, monkeypatch):
    path = tmp_path / "all.jsonl"
    written(path, [answer(1.0, 2.0)])
    before, write = path.read_bytes(), os.write

    def half(file, line):
        if len(line) < 20:
            raise OSError(28, "No space left on device")
        return write(file, line[: len(line) // 2])

    journal = Journal(own=path)
    monkeypatch.setattr(os, "write", half)
    with pytest.raises(OSError, match=r"No space left on device: .*all\.jsonl"):
        journal.add(("point", 1, -1), answer(3.0, 4.0))
    monkeypatch.undo()
    assert path.read_bytes() == before and ("point", 1, -1) not in journal
    journal.add(("point", 1, -1), answer(3.0, 4.0))
    assert journal.values(("point", 1, -1)) == [3.0, 4.0]
    journal.close()

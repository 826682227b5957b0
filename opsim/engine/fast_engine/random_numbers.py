"""Numbers of named streams: the next of one, or a certain one; more are asked for from Python, whole blocks at once."""

from __future__ import annotations

from typing import Any

from opsim.engine.fast_engine.floor_state import Floor
from opsim.engine.fast_engine.machine import address_of, call_out, fresh, inlined, step
from opsim.engine.fast_engine.machine.intrinsics import array_at, words_at
from opsim.engine.fast_engine.records import Stream
from opsim.streams import BLOCK

DURATION, AUTOMATIC, GAP, MIX, REPAIR, UPTIME, ROUTING, START, YIELD, QUALITY, ABSENCE, HOLD, HOLD_RUN = range(1, 14)
"""Purposes of streams. An id is purpose, then three ranks of 16 bits, in that order: see ``named.NAMED``."""
MOST_RANKS = 1 << 16
new_stream = fresh(Stream)
_floats_at = array_at("float")
TABLE, MASK = range(2)
"""Words of ``floor.drawn``: where the table of what was drawn before the run is, and its number of places less 1."""
ID, DATA, END, USED, DATA_2, DATA_3 = range(6)
WIDTH = 8
"""Words of a place: of which stream, where its numbers from 0 on are, how many, up to which they were asked for."""


def place_of(stream: int, mask: int) -> int:
    """Where a stream is looked for first in a table; the next places are tried one by one. NOTE: no product here is
    beyond 2^63, so Python and compiled code find the same."""
    folded = stream ^ (stream >> 32)
    folded = (folded ^ (folded >> 15)) & 0xFFFFFF
    return ((folded * 0x9E3779B1) >> 20) & mask


_place_of = inlined(place_of)


@inlined
def stream_id(purpose: int, one: int, two: int, three: int) -> int:
    return (purpose << 48) | (one << 32) | (two << 16) | three


@inlined
def stream_of(floor: Floor, purpose: int, one: int, two: int, three: int) -> Stream:
    """A stream from its beginning. Raises OverflowError for a rank beyond; of Plans ``limits`` has looked before."""
    if (one | two | three) >= MOST_RANKS:
        raise OverflowError("over 65,536 visits of a step by one job; --engine simpy runs it")
    stream: Stream = new_stream(floor)
    stream.id = stream_id(purpose, one, two, three)
    return stream


def planned(build: Any, purpose: int, rank: int) -> Any:
    """A stream from its beginning, of a floor that is being set up."""
    made = build.arena.new("Stream")
    made.id = purpose << 48 | rank << 32
    return made


@step
def more_numbers(floor: Floor, stream: Stream, item: int) -> None:
    """A block of what was drawn before the run, with the item in it; else Python is asked for more.

    NOTE: one block after the other although all are there, so that it is known how many were wanted.
    """
    table, mask, wanted = words_at(floor.drawn[TABLE]), floor.drawn[MASK], stream.id
    at = _place_of(wanted, mask)
    while table[at * WIDTH] != wanted and table[at * WIDTH] != 0:
        at = (at + 1) & mask
    at = at * WIDTH
    if item >= table[at + END]:
        call_out(floor.more_luck, address_of(stream), item)
        if item >= stream.end:
            raise RuntimeError("no numbers were drawn")
        return
    stream.first, stream.end = 0, (item | (BLOCK - 1)) + 1
    if table[at + USED] < stream.end:
        table[at + USED] = stream.end
    stream.data = _floats_at(table[at + DATA])
    stream.data_2, stream.data_3 = _floats_at(table[at + DATA_2]), _floats_at(table[at + DATA_3])


@inlined
def next_number(floor: Floor, stream: Stream) -> float:
    """The next one of a stream whose numbers come one after the other; ``stream.next`` is its successor's number."""
    if stream.next == stream.end:
        more_numbers(floor, stream, stream.next)
    number = stream.next
    stream.next = number + 1
    return stream.data[number - stream.first]


@inlined
def next_held(floor: Floor, stream: Stream) -> float:
    """The next duration of a stream; the shares between which the tool is held are in ``floor.holds``."""
    if stream.next == stream.end:
        more_numbers(floor, stream, stream.next)
    at = stream.next - stream.first
    stream.next += 1
    floor.holds.start, floor.holds.end = stream.data_2[at], stream.data_3[at]
    return stream.data[at]


@inlined
def number_at(floor: Floor, stream: Stream, item: int) -> float:
    """A certain one of a stream that is asked in no order: all before it are kept. ``stream.next`` is -1 in these."""
    if item >= stream.end:
        stream.next = -1
        more_numbers(floor, stream, item)
    return stream.data[item]

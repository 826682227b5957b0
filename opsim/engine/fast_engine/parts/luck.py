"""Numbers of named streams: the next of one, or a certain one; more are asked for from Python, whole blocks at once."""

from __future__ import annotations

from opsim.engine.fast_engine.machine import address_of, call_out, fresh, inlined
from opsim.engine.fast_engine.parts.records import Stream
from opsim.engine.fast_engine.parts.state import Floor

DURATION, AUTOMATIC, GAP, MIX, REPAIR, UPTIME, ROUTING, START, YIELD, QUALITY, ABSENCE, HOLD, HOLD_RUN = range(1, 14)
"""Purposes of streams. An id is purpose, then three ranks of 16 bits, in that order: see ``luck_of`` of the engine."""
new_stream = fresh(Stream)


@inlined
def stream_id(purpose: int, one: int, two: int, three: int) -> int:
    return (purpose << 48) | (one << 32) | (two << 16) | three


@inlined
def stream_of(floor: Floor, purpose: int, one: int, two: int, three: int) -> Stream:
    """A stream from its beginning."""
    stream: Stream = new_stream(floor)
    stream.id = stream_id(purpose, one, two, three)
    return stream


@inlined
def next_number(floor: Floor, stream: Stream) -> float:
    """The next one of a stream whose numbers come one after the other; ``stream.next`` is its successor's number."""
    if stream.next == stream.end:
        call_out(floor.more_luck, address_of(stream), stream.next)
    number = stream.next
    stream.next = number + 1
    return stream.data[number - stream.first]


@inlined
def number_at(floor: Floor, stream: Stream, item: int) -> float:
    """A certain one of a stream that is asked in no order: all before it are kept. ``stream.next`` is -1 in these."""
    if item >= stream.end:
        stream.next = -1
        call_out(floor.more_luck, address_of(stream), item)
    return stream.data[item]

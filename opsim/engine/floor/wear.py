"""What is left until a station breaks down: seconds by the clock, seconds at work, or cycles."""

from __future__ import annotations

from opsim.engine.floor.machine import NOTHING, inlined, step
from opsim.engine.floor.parts.clock import on_grid
from opsim.engine.floor.parts.events import alarm, cancel
from opsim.engine.floor.parts.failing import Stop
from opsim.engine.floor.parts.luck import next_number
from opsim.engine.floor.parts.state import Floor
from opsim.engine.floor.parts.wear import Countdown, Wear
from opsim.engine.rules import BREAKDOWN


@inlined
def _run(floor: Floor, countdown: Countdown) -> None:
    """The seconds go by from now on."""
    if not countdown.alarm and countdown.left_s > 0:
        stop = countdown.stop
        countdown.since_s = floor.now
        countdown.alarm = alarm(
            floor, countdown.left_s, BREAKDOWN, stop.station.rank, stop.rank, countdown.line, countdown
        )


@inlined
def _hold(floor: Floor, countdown: Countdown) -> None:
    """The seconds stand still; what is left is kept, to the last tick."""
    if countdown.alarm:
        cancel(countdown.alarm)
        countdown.left_s -= floor.now - countdown.since_s
        countdown.alarm = NOTHING


@step
def work_begins(floor: Floor, wear: Wear) -> None:
    """A performance begins."""
    wear.n_at_work += 1
    if wear.n_at_work == 1:
        for i in range(len(wear.busy)):
            _run(floor, wear.busy[i])


@step
def work_ends(floor: Floor, wear: Wear) -> None:
    """A performance ends, or is broken off."""
    wear.n_at_work -= 1
    if wear.n_at_work == 0:
        for i in range(len(wear.busy)):
            _hold(floor, wear.busy[i])


@step
def cycle_done(floor: Floor, wear: Wear) -> None:
    """An operation is done."""
    for i in range(len(wear.cycles)):
        wear.cycles[i].left -= 1.0


@step
def clock_stops(floor: Floor, wear: Wear) -> None:
    """The station stops; what it does has been broken off before."""
    for i in range(len(wear.clock)):
        _hold(floor, wear.clock[i])


@step
def clock_goes_on(floor: Floor, wear: Wear) -> None:
    """The station is up; what is at work on it begins after this."""
    for i in range(len(wear.clock)):
        _run(floor, wear.clock[i])


@step
def renew(floor: Floor, wear: Wear, stop: Stop) -> None:
    """A breakdown is repaired: what counts towards it begins anew."""
    for i in range(len(wear.clock)):
        if wear.clock[i].stop is stop:
            wear.clock[i].left_s = on_grid(next_number(floor, wear.clock[i].gaps))
    for i in range(len(wear.busy)):
        if wear.busy[i].stop is stop:
            wear.busy[i].left_s = on_grid(next_number(floor, wear.busy[i].gaps))
    for i in range(len(wear.cycles)):
        if wear.cycles[i].stop is stop:
            wear.cycles[i].left = next_number(floor, wear.cycles[i].gaps)

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
        for one in wear.busy:
            _run(floor, one)


@step
def work_ends(floor: Floor, wear: Wear) -> None:
    """A performance ends, or is broken off."""
    wear.n_at_work -= 1
    if wear.n_at_work == 0:
        for one in wear.busy:
            _hold(floor, one)


@step
def cycle_done(floor: Floor, wear: Wear) -> None:
    """An operation is done."""
    for one in wear.cycles:
        one.left -= 1.0


@step
def clock_stops(floor: Floor, wear: Wear) -> None:
    """The station stops; what it does has been broken off before."""
    for one in wear.clock:
        _hold(floor, one)


@step
def clock_goes_on(floor: Floor, wear: Wear) -> None:
    """The station is up; what is at work on it begins after this."""
    for one in wear.clock:
        _run(floor, one)


@step
def renew(floor: Floor, wear: Wear, stop: Stop) -> None:
    """A breakdown is repaired: what counts towards it begins anew."""
    for one in wear.clock:
        if one.stop is stop:
            one.left_s = on_grid(next_number(floor, one.gaps))
    for other in wear.busy:
        if other.stop is stop:
            other.left_s = on_grid(next_number(floor, other.gaps))
    for each in wear.cycles:
        if each.stop is stop:
            each.left = next_number(floor, each.gaps)

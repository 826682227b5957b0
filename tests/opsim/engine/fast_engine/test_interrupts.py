"""Signals wait while compiled code runs: nothing is raised where Python would lose it, and nothing is lost."""

import signal
import threading

import pytest

from opsim.engine.fast_engine.machine.calling import handled, signals_wait

pytestmark = pytest.mark.skipif(not hasattr(signal, "SIGUSR1"), reason="there are no such signals")


class Came(Exception):
    pass


@pytest.fixture
def told():
    """Numbers of the signals that were handled; one more is raised as an error."""
    found = []

    def handler(number, _frame):
        found.append(number)
        if number == signal.SIGTERM:
            raise Came

    before = {number: signal.signal(number, handler) for number in (signal.SIGUSR1, signal.SIGTERM)}
    yield found
    for number, one in before.items():
        signal.signal(number, one)


def test_a_signal_is_handled_at_the_end(told):
    with pytest.raises(Came), signals_wait():
        signal.raise_signal(signal.SIGTERM)
        assert told == []
    assert told == [signal.SIGTERM]


def test_or_sooner_where_somebody_asks_for_that(told):
    with pytest.raises(Came), signals_wait() as waiting:
        waiting.handle()
        signal.raise_signal(signal.SIGUSR1)
        waiting.handle()
        assert told == [signal.SIGUSR1]
        signal.raise_signal(signal.SIGTERM)
        waiting.handle()
        pytest.fail("went on")


def test_a_handler_that_raises_nothing_ends_nothing(told):
    with signals_wait() as waiting:
        signal.raise_signal(signal.SIGUSR1)
        waiting.handle()
        signal.raise_signal(signal.SIGUSR1)
    assert told == [signal.SIGUSR1] * 2


def test_what_takes_long_is_ended_at_once_and_after_that_signals_wait_again(told):
    with signals_wait():
        with pytest.raises(Came):
            handled(lambda: (signal.raise_signal(signal.SIGTERM), pytest.fail("went on")))
        signal.raise_signal(signal.SIGUSR1)
        assert told == [signal.SIGTERM]
        assert handled(lambda one, other: one + other, 1, 2) == 3
        assert told == [signal.SIGTERM, signal.SIGUSR1]
    assert handled(lambda: 4) == 4


def test_handlers_are_what_they_were_afterwards_also_one_that_was_changed_meanwhile(told):
    before = signal.getsignal(signal.SIGUSR1)
    with signals_wait():
        assert signal.getsignal(signal.SIGUSR1) != before
        signal.signal(signal.SIGTERM, signal.SIG_IGN)
    assert signal.getsignal(signal.SIGUSR1) == before
    assert signal.getsignal(signal.SIGTERM) == signal.SIG_IGN


def test_who_ignores_what_comes_later_is_not_told_of_it(told):
    def once(number, _frame):
        told.append(number)
        signal.signal(number, signal.SIG_IGN)
        raise Came

    signal.signal(signal.SIGTERM, once)
    with pytest.raises(Came), signals_wait():
        signal.raise_signal(signal.SIGTERM)
        signal.raise_signal(signal.SIGTERM)
    assert told == [signal.SIGTERM]


def test_a_run_inside_a_run_hands_on_what_comes(told):
    with pytest.raises(Came), signals_wait():
        with signals_wait():
            signal.raise_signal(signal.SIGTERM)
        assert told == []


def test_other_threads_wait_for_nothing(told):
    def run():
        with signals_wait() as waiting:
            waiting.handle()
            found.append((handled(lambda: 5), dict(waiting.handlers)))

    found = []
    thread = threading.Thread(target=run)
    thread.start()
    thread.join()
    assert found == [(5, {})]

"""The option ``--engine`` of all verbs that run something, and what is said of the engine that is taken."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import click

from opsim.engine.choice import AUTO, ENGINES, SIMPY, Choice, Told, known

if TYPE_CHECKING:
    from opsim.cli.progress import Report
    from opsim.study.engine_choice import Chosen

COMPILING = "compiling the fast engine (once)"
NOT_KEPT = "compiling the fast engine (each time, as it can be kept nowhere: set NUMBA_CACHE_DIR)"


class EngineWord(click.Choice):  # type: ignore[type-arg]  # of click 8.1 it takes none
    """One of the engines; of another word the nearest one is said."""

    def __init__(self) -> None:
        super().__init__(ENGINES)

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> str:
        """Raises BadParameter."""
        try:
            return known(value)
        except ValueError as error:
            self.fail(str(error).removeprefix("engine: "), param, ctx)


def engine_option(default: str | None = SIMPY) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """default : None where it is known later whether anything is run; that is SIMPY then"""
    words = "What runs it; the results are the same. auto: the fast one where that is sooner.  [default: simpy]"
    return click.option("--engine", type=EngineWord(), default=default, help=words)


def telling(what: str, report: Report, said: set[str] | None = None) -> Chosen:
    """Says which engine ``auto`` takes, and that the fast one is compiled; ``what`` is being done.

    said : sentences that are not said again, and what is said is added to them
    """
    before = set[str]() if said is None else said

    def chosen(choice: Choice) -> Told | None:
        if choice.asked == AUTO and choice.words not in before:
            report.say(f"{what}: {choice.words}")
            before.add(choice.words)
        return lambda done, total: report.once(done, total, _compiling())

    return chosen


def _compiling() -> str:
    from opsim.engine.fast_engine import is_kept

    return COMPILING if is_kept() else NOT_KEPT

"""The engine of one run: taken before its first replication, and looked at again where more of them come."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from opsim.engine.choice import Choice
from opsim.plan import Plan
from opsim.study.engine_choice import Chosen, compiled_for, engine_of
from opsim.study.folder import say_engine
from opsim.study.replicate import missing


class EngineOfRun:
    """Ready for replications 0 .. n-1 of a folder: written down, told of and compiled, where any is to be made."""

    def __init__(
        self, choice: Choice, loaded: Any, plan: Plan, folder: Path, processes: int | None, chosen: Chosen | None
    ):
        """chosen : is told the engine before anything is run"""
        self._choice, self._loaded, self._plan, self._folder = choice, loaded, plan, folder
        self._processes, self._chosen = processes, chosen
        self._is_ready, self._runs = False, 0

    def upto(self, n: int) -> Choice:
        """For the first n replications. Raises OSError where it cannot be written down."""
        left = missing(self._folder, n)
        self._runs += left
        if left and not self._is_ready:
            self._take(self._choice)
        elif left and self._choice.may_pay:
            again = engine_of(self._choice.asked, self._loaded, self._plan, self._runs, processes=self._processes)
            if again.engine != self._choice.engine:
                self._take(again)
        return self._choice

    def _take(self, choice: Choice) -> None:
        self._choice, self._is_ready = choice, True
        say_engine(self._folder, choice)
        compiled_for(choice, self._plan, self._chosen)

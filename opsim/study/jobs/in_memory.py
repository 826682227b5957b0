"""Answers that are kept no longer than the process that asked for them."""

from __future__ import annotations

from opsim.results import Key
from opsim.study.jobs.answer import Answer, keys_in
from opsim.study.jobs.journal import Address


class InMemory:
    """As a Journal without files."""

    def __init__(self) -> None:
        self._found: dict[Address, tuple[list[Key], tuple[float, ...]]] = {}
        self._keys: dict[str, list[Key]] = {}

    def __contains__(self, address: Address) -> bool:
        return address in self._found

    def add(self, address: Address, answer: Answer) -> None:
        """Keep an answer."""
        keys = self._keys.setdefault(answer.figures, keys_in(answer.figures))
        self._found[address] = keys, answer.values

    def keys(self, address: Address) -> list[Key]:
        """The figures of an answer that is there."""
        return self._found[address][0]

    def values(self, address: Address) -> list[float]:
        """The numbers of an answer that is there, in the order of its keys."""
        return list(self._found[address][1])

"""A small safe language to choose repetitions: ``cov_correct == 1 and (worker in (s01, s02) or not cov_vmax > 5)``.

    expression = term {"or" term};  term = factor {"and" factor};
    factor = "not" factor | "(" expression ")" | comparison
    comparison = name ("==" "!=" "<" "<=" ">" ">=") value | name ["not"] "in" "(" value {"," value} ")"
A value is a number or a word (quotes optional). A name may leave out its ``cov_``; ``subject`` means ``worker``.
"""

from __future__ import annotations

import operator
import re
from collections.abc import Mapping, Sequence
from difflib import get_close_matches
from typing import Any

import numpy as np

_TOKEN = re.compile(r"\s*(==|!=|<=|>=|<|>|\(|\)|,|'[^']*'|\"[^\"]*\"|[-+]?\d[\w.+-]*|[A-Za-z_][\w.-]*)")
_COMPARE = {
    "==": operator.eq,
    "!=": operator.ne,
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
}
_WORDS = {"and", "or", "not", "in"}
DEEPEST = 50
"""Brackets and ``not`` inside one another; nobody means more."""


class WhereError(ValueError):
    """An expression that cannot be read: the message points at the word and says what was expected."""


def rows_where(text: str, columns: Mapping[str, Sequence[Any]]) -> np.ndarray:
    """Which rows of the columns (each N long) fulfil the expression: (N,) bool. Raises WhereError."""
    reader = _Reader(text, columns)
    rows = reader.expression()
    if reader.peek() is not None:
        reader.fail("'and', 'or' or the end")
    return rows


class _Reader:
    """Recursive descent over the tokens; each rule returns its rows (N,) bool."""

    def __init__(self, text: str, columns: Mapping[str, Sequence[Any]]) -> None:
        self.text, self.columns, self.at, self.depth = text, columns, 0, 0
        self.tokens = self._split()

    def _split(self) -> list[str]:
        tokens, place = [], 0
        while self.text[place:].strip():
            found = _TOKEN.match(self.text, place)
            if not found:
                rest = self.text[place:].strip()
                hint = "; write == for equals" if rest.startswith("=") else ""
                raise WhereError(f"where {_short(self.text)!r}: cannot read {_short(rest)!r}{hint}")
            tokens.append(found.group(1))
            place = found.end()
        return tokens

    def peek(self) -> str | None:
        return self.tokens[self.at] if self.at < len(self.tokens) else None

    def take(self, *expected: str) -> str:
        token = self.peek()
        if token is None or (expected and token not in expected):
            self.fail(" or ".join(repr(word) for word in expected) if expected else "a word")
        self.at += 1
        assert token is not None
        return token

    def fail(self, expected: str) -> None:
        raise WhereError(f"where {_short(self.text)!r}: expected {expected}, found {self.peek() or 'the end'!r}")

    def expression(self) -> np.ndarray:
        rows = self.term()
        while self.peek() == "or":
            self.take()
            rows = rows | self.term()
        return rows

    def term(self) -> np.ndarray:
        rows = self.factor()
        while self.peek() == "and":
            self.take()
            rows = rows & self.factor()
        return rows

    def factor(self) -> np.ndarray:
        self.depth += 1
        if self.depth > DEEPEST:
            raise WhereError(f"where {_short(self.text)!r}: brackets and 'not' nest deeper than {DEEPEST}")
        rows = self.nested()
        self.depth -= 1
        return rows

    def nested(self) -> np.ndarray:
        if self.peek() == "not":
            self.take()
            return ~self.factor()
        if self.peek() == "(":
            self.take()
            rows = self.expression()
            self.take(")")
            return rows
        return self.comparison()

    def comparison(self) -> np.ndarray:
        column = self.column()
        word = self.take(*_COMPARE, "in", "not")
        if word in _COMPARE:
            return self.compare(column, _COMPARE[word], self.value())
        if word == "not":
            self.take("in")
        values = self.values()
        rows = np.any([self.compare(column, operator.eq, value) for value in values], axis=0)
        return ~rows if word == "not" else rows

    def column(self) -> Sequence[Any]:
        name = self.peek()
        if name is None or name in _WORDS or not (name[0].isalpha() or name[0] == "_"):
            self.fail("a covariate")
        name = self.take()
        for known in ("worker" if name == "subject" else name, f"cov_{name}"):
            if known in self.columns:
                return self.columns[known]
        near = get_close_matches(name, self.columns, n=1)
        hint = f"did you mean {near[0]!r}?" if near else f"known: {', '.join(sorted(self.columns))}"
        raise WhereError(f"where {_short(self.text)!r}: no covariate {name!r}; {hint}")

    def values(self) -> list[str | float]:
        self.take("(")
        values = [self.value()]
        while self.take(",", ")") == ",":
            values.append(self.value())
        return values

    def value(self) -> str | float:
        token = self.peek()
        if token is None or token in _COMPARE or token in _WORDS or token in ("(", ")", ","):
            self.fail("a value")
        token = self.take()
        if token[0] in "'\"":
            return token[1:-1]
        try:
            return float(token)
        except ValueError:
            return token

    def compare(self, column: Sequence[Any], test: Any, value: str | float) -> np.ndarray:
        if isinstance(value, float) and not any(isinstance(entry, str) for entry in column):
            return np.array([bool(test(float(entry), value)) for entry in column])
        if test not in (operator.eq, operator.ne):
            raise WhereError(
                f"where {_short(self.text)!r}: {value!r} is not a number and words have no order; use == or !="
            )
        word = f"{value:g}" if isinstance(value, float) else value
        return np.array([bool(test(str(entry), word)) for entry in column])


def _short(text: str) -> str:
    return text if len(text) <= 120 else f"{text[:60]} ... {text[-40:]}"

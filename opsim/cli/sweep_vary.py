"""``--vary``: a path and its values, as text."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any

from opsim.problems import ScenarioError, shown

EXAMPLE = "such as 'release.every=40 s..60 s' or 'stations.saw.buffer=1,2,4'"
_DOTS = re.compile(r"\s*\.\.\s*")


def vary_of(texts: Sequence[str]) -> dict[str, Any]:
    """``["release.every=40 s..60 s"]`` -> {"release.every": {"from": "40 s", "to": "60 s"}}, as a file would have it.

    Raises ValueError with all mistakes, a line each.
    """
    found: dict[str, Any] = {}
    wrong = []
    for text in texts:
        path, equals, values = (part.strip() for part in text.partition("="))
        try:
            if not path or not equals or not values:
                raise ValueError(f"expected a path, '=' and values; {EXAMPLE}")
            if path in found:
                raise ValueError(f"{path} is given twice; give all of its values at once")
            found[path] = _values(values)
        except ValueError as error:
            wrong.append(f"--vary {shown(text)}: {error}")
    if wrong:
        raise ValueError("\n".join(wrong))
    return found


def _values(text: str) -> Any:
    """A range, or a list of values as YAML has them between brackets."""
    ends = _DOTS.split(text)
    if len(ends) == 1:
        return _yaml(f"[{text}]")
    if len(ends) > 2 or not all(ends):
        raise ValueError(f"a range has two ends, found {shown(text)}; {EXAMPLE}")
    low, high = (_yaml(f"[{end}]") for end in ends)
    if len(low) != 1 or len(high) != 1:
        raise ValueError(f"a range has one value at each end, found {shown(text)}; {EXAMPLE}")
    return {"from": low[0], "to": high[0]}


def _yaml(text: str) -> list[Any]:
    from opsim.scenario.yaml_nodes import read_tree

    try:
        tree, problems = read_tree(f"values: {text}".encode(), "--vary")
    except ScenarioError as error:
        problems = list(error.problems)
    if problems:
        raise ValueError(f"cannot be read as values: {problems[0].message}")
    plain: Any = tree.plain()
    values: list[Any] = plain["values"]
    return values

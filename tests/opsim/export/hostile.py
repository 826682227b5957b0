"""A log and its plan with names that would do harm where they are taken for paths, formulas, HTML or SQL.

The scenario language refuses such names; those of somebody's own SimPy model are his.
"""

from dataclasses import replace
from itertools import count

UP, SCRIPT, FORMULA = "../../up", "<script>alert(1)</script>", '=HYPERLINK("http://x")'
SQL, MINUS, AT, TWO = "a'); DROP TABLE event; --", "-2+3", "@SUM(A1)", 'two\nlines\t"and" more'
HARMFUL = (UP, SCRIPT, FORMULA, SQL, MINUS, AT, TWO)


def harmful(names):
    """As many names, no two alike."""
    numbers = count()
    return tuple(f"{HARMFUL[n % len(HARMFUL)]}{n // len(HARMFUL) or ''}" for n, _ in zip(numbers, names))


def hostile(log, plan):
    """The same log and plan under harmful names; products among them "object" and "map_type", as tables are called."""
    renamed = {
        name: harmful(log.names[name])
        for name in ("worker", "station", "place_from", "place_to", "source", "operation", "task")
    }
    renamed["product"] = ("object", "Object", "map type", *harmful(log.names["product"]))[: len(log.names["product"])]
    new = {
        field: tuple(replace(one, name=name) for one, name in zip(getattr(plan, field), renamed[column]))
        for field, column in (
            *(("workers", "worker"), ("stations", "station"), ("sources", "source")),
            *(("tasks", "task"), ("products", "product")),
        )
    }
    plan = replace(plan, name=SCRIPT, places=renamed["place_from"], **new)
    return replace(log, names={**log.names, **renamed}), plan

"""What lies in stores at the start holds cards: no more pieces than there are cards for them."""

from __future__ import annotations

from collections.abc import Iterator

from opsim.problems import Problem, shown
from opsim.scenario.checks.cards import passes, values
from opsim.scenario.checks.ways import stations_of
from opsim.scenario.positions import Node, Place, child, entries, problem


def card_stock_problems(tree: Node) -> Iterator[Problem]:
    """Loops with fewer cards than pieces that lie inside them at the start."""
    for name, card in entries(tree, "cards").items():
        n = child(card, "n")
        pieces, place = _inside(tree, card)
        if n is not None and isinstance(n.value, int) and place is not None and pieces > n.value > 0:
            found = f"{pieces} pieces lie inside the loop {shown(name)} at the start, which has {n.value} cards"
            yield problem(place, ("cards", name, "n"), found, f"give it at least {pieces}, or begin with less")


def _inside(tree: Node, card: Node) -> tuple[int, Place | None]:
    """The jobs in stores at the start that hold a card of a loop, and where the last of them are said."""
    begin, end, asked = (values(card, key) for key in ("from", "to", "products"))
    total, place = 0, None
    for store, block in entries(tree, "stores").items():
        if end and store not in end:
            continue
        for product, number, node in _initial(tree, store, block):
            made = entries(tree, "products").get(product)
            if made is not None and (not asked or product in asked) and passes(made, begin, end):
                total, place = total + number, node.place
    return total, place


def _initial(tree: Node, store: str, block: Node) -> Iterator[tuple[str, int, Node]]:
    """(product, jobs, node) of what lies in a store at the start; a number alone is of the product that ends there."""
    initial = child(block, "initial")
    if initial is None:
        return
    ends = [name for name, product in entries(tree, "products").items() if store in stations_of(product)]
    said = entries(initial) or dict.fromkeys(ends[:1], initial)
    for product, node in said.items():
        if isinstance(node.value, int) and not isinstance(node.value, bool):
            yield product, node.value, node

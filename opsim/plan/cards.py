"""Loops of cards: where each product takes one, and where it is given back."""

from dataclasses import dataclass
from typing import Any

from opsim.names import natural_key
from opsim.plan.material import ProductPlan
from opsim.plan.ranks import Ranks
from opsim.plan.release import INSIDE, SourcePlan


@dataclass(frozen=True, slots=True)
class CardPlan:
    """n cards, one for each job between two points.

    steps : (P,) of each product the steps of its route before which it takes one; empty where it needs none
    back  : ranks of the points at whose leaving it is given back; empty: on the way out
    """

    name: str
    n: int
    steps: tuple[tuple[int, ...], ...]
    back: tuple[int, ...]


def plan_cards(
    scenario: Any, ranks: Ranks, products: tuple[ProductPlan, ...], sources: tuple[SourcePlan, ...]
) -> tuple[CardPlan, ...]:
    """All loops in natural order of names.

    Products that no source makes, such as the pieces of a split, come from inside: of a loop that begins at the first
    station they need a card only where it names them.
    """
    released = {products[rank].name for source in sources if source.kind != INSIDE for rank, _ in source.mix}
    return tuple(
        _card(name, card, ranks, products, released)
        for name, card in sorted(scenario.cards.items(), key=lambda item: natural_key(item[0]))
    )


def _card(name: str, card: Any, ranks: Ranks, products: tuple[ProductPlan, ...], released: set[str]) -> CardPlan:
    begin, end = ({ranks.stations[point] for point in points or ()} for points in (card.begin, card.end))
    asked = card.products or (released if card.begin is None else set(ranks.products))
    steps = tuple(_steps(product, begin, end) if product.name in asked else () for product in products)
    return CardPlan(name, card.n, steps, tuple(sorted(end)))


def _steps(product: ProductPlan, begin: set[int], end: set[int]) -> tuple[int, ...]:
    """The steps before which a product takes a card: those from which a way leads to where it is given back."""
    if begin:
        first = [step for step, operation in enumerate(product.route) if begin.intersection(operation.stations)]
    else:
        first = sorted({step for _, step in product.start})
    return tuple(step for step in first if not end or _leads_to(product, step, end))


def _leads_to(product: ProductPlan, step: int, end: set[int]) -> bool:
    """Whether a way leads from a step of a product, or that step itself is, one of some points."""
    seen, todo = {step}, [step]
    while todo:
        here = todo.pop()
        if end.intersection(product.route[here].stations):
            return True
        onward = {other for _, other in product.onward[here] if other >= 0} - seen
        seen |= onward
        todo += onward
    return False

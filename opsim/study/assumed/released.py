"""How jobs come in and what holds them back, as lines of the assumption sheet."""

from collections.abc import Iterator

from opsim.names import listed
from opsim.plan import Plan
from opsim.plan.release import BASE_STOCK, INSIDE, POISSON, RENEWAL, SATURATED, SCHEDULE, SourcePlan

_HOW = {POISSON: "at random (Poisson)", RENEWAL: "with gaps of their own distribution (renewal)"}


def released(plan: Plan) -> Iterator[tuple[str, str]]:
    """(topic, what is assumed) of each source, and of the loops of cards."""
    sources = [source for source in plan.sources if source.kind != INSIDE]
    for source in sources:
        said = _said(plan, source)
        if said:
            yield "release", said if len(sources) == 1 else f"{source.name}: {said}"
    for card in plan.cards:
        who = [product.name for product, steps in zip(plan.products, card.steps) if steps]
        whose = "" if len(who) == len(plan.products) else f" of {listed(who)}"
        back = " or ".join(plan.stations[rank].name for rank in card.back)
        end = f"when it leaves {back}" if back else "on the way out"
        yield "cards", f"{card.name}: at most {card.n} jobs{whose} at once; a job gives its card back {end}, in no time"


def _said(plan: Plan, source: SourcePlan) -> str:
    if source.kind in _HOW:
        rate = f"jobs come {_HOW[source.kind]}, one every {source.every_s:g} s on average; none come in lots"
        several = f"{source.at_once} jobs come at once {_HOW[source.kind]}, every {source.every_s:g} s on average"
        return rate if source.at_once == 1 else several
    if source.kind == SCHEDULE:
        n_jobs, total = sum(order.quantity for order in source.orders), len(source.orders) + source.n_late
        late = f"; {source.n_late} of its {total} orders come at the horizon or later" if source.n_late else ""
        return f"{n_jobs} jobs come at the times of the file, none early or late{late}"
    if source.kind == BASE_STOCK:
        product, store = plan.products[source.mix[0][0]].name, plan.stations[source.store].name
        return (
            f"a {product} is begun whenever fewer than {source.level} are in {store} or on the way, less those wanted"
        )
    assert source.kind == SATURATED
    return "in the order of the sequence, again and again" if source.sequence else ""

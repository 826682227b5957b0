"""What comes in: one release or several sources, of products that there are, by files that can be read.

A saturated source must come to an end: a buffer with a limit, or cards.

What the assumption sheet says of sources, and of cards.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from opsim.csv_input import Mistake, RecordedError, read_orders, read_sequence, resolve_times
from opsim.plan import Plan
from opsim.problems import Assumption, Problem, did_you_mean, listed, nearest, shown
from opsim.scenario.checks import lookup
from opsim.scenario.checks.lookup import first_of, in_the_file, made_by, releases, stations_of
from opsim.scenario.schema import Scenario
from opsim.scenario.tree import Node, Place, TreePath, child, entries, items, problem, text
from opsim.subjects.material.checks import passes, values
from opsim.subjects.release.plan import BASE_STOCK, INSIDE, POISSON, RENEWAL, SATURATED, SCHEDULE, SourcePlan
from opsim.subjects.release.words import MOST_AT_ONCE


def source_problems(tree: Node, folder: Path) -> Iterator[Problem]:
    """Everything wrong with what a release, or each of the sources, says of other parts of the file."""
    yield from _one_way(tree)
    for path, release in lookup.releases(tree).items():
        yield from _products(tree, release, path)
        yield from _files(tree, release, path, folder)
        if text(release, "kind") == "base_stock":
            yield from _store(tree, release, path)


def _one_way(tree: Node) -> Iterator[Problem]:
    """Either a release or sources."""
    release, sources = child(tree, "release"), child(tree, "sources")
    if release is not None and sources is not None:
        hint = "write the release as one of the sources"
        yield problem(sources.name_place, ("sources",), "jobs come in by release and by sources", hint)
    unsaid = release is None and (sources is None or sources.value == {})
    mistyped = any(nearest(key, ("release", "sources")) for key in entries(tree) if key not in Scenario.model_fields)
    if unsaid and not mistyped:
        place = tree.place if sources is None else sources.name_place
        yield problem(place, "", "nothing says how jobs come in", "add e.g. 'release: {kind: poisson, every: 55 s}'")


def _products(tree: Node, release: Node, path: TreePath) -> Iterator[Problem]:
    products = entries(tree, "products")
    named: list[tuple[str, Place, TreePath]] = [
        (name, node.name_place, ("products", name)) for name, node in entries(release, "products").items()
    ]
    for key in ("products", "sequence"):
        listed = enumerate(items(release, key))
        named += [(node.value, node.place, (key, number)) for number, node in listed if isinstance(node.value, str)]
    for name, place, where in named:
        if name not in products:
            hint = did_you_mean(name, products, otherwise="known products")
            yield problem(place, (*path, *where), f"no product {shown(name)}", hint)


def _files(tree: Node, release: Node, path: TreePath, folder: Path) -> Iterator[Problem]:
    """Lists of orders and sequences that cannot be read, every mistake of each."""
    for key in ("file", "sequence"):
        name = text(release, key)
        if name is None or (key == "file" and text(release, "kind") != "schedule"):
            continue
        place = release.value[key].place
        try:
            mistakes, says = _read(key, name, folder, tree)
        except RecordedError as error:
            yield problem(place, (*path, key), error.message, error.hint)
            continue
        yield from in_the_file(folder / name, (*path, key), mistakes)
        if key == "file" and says and lookup.says_products(release):
            hint = "remove the column, or products and sequence"
            yield problem(place, (*path, key), f"the products come from {shown(name)} and from the source", hint)


def _read(key: str, name: str, folder: Path, tree: Node) -> tuple[list[Mistake], bool]:
    """The mistakes of a file, and whether it says products. Raises RecordedError where it is no table."""
    file, products = resolve_times(name, folder), entries(tree, "products")
    if key == "sequence":
        return read_sequence(file, products)[1], True
    orders, mistakes = read_orders(file, products)
    return mistakes, any(order.product is not None for order in orders)


def _store(tree: Node, release: Node, path: TreePath) -> Iterator[Problem]:
    """A base stock is kept in a store, of the one product that goes there."""
    node, stores = child(release, "store"), entries(tree, "stores")
    if node is None or not isinstance(node.value, str):
        return
    place: Place = node.place
    if node.value not in stores:
        hint = did_you_mean(node.value, stores, otherwise="known stores") or "there are no stores yet"
        yield problem(place, (*path, "store"), f"no store {shown(node.value)}", hint)
        return
    ending = [name for name, product in entries(tree, "products").items() if node.value in stations_of(product)]
    named = lookup.made_by(tree, release) if lookup.says_products(release) else ending
    if not ending:
        hint = f"end the route of a product with {node.value}"
        yield problem(place, (*path, "store"), f"no product's way ends in {shown(node.value)}", hint)
    elif len(named) > 1:
        found_here = f"{' and '.join(named[:3])} end in {shown(node.value)}, and a base_stock release is of one product"
        yield problem(place, (*path, "store"), found_here, f"add 'products: [{named[0]}]', and a source for each other")
    elif named[0] in entries(tree, "products") and named[0] not in ending:
        at = child(release, "products")
        yield problem(
            place if at is None else at.place, (*path, "products"), f"{named[0]} does not end in {shown(node.value)}"
        )


def saturated_problems(tree: Node) -> Iterator[Problem]:
    """Saturated sources into buffers that would never be full, or only after very many jobs."""
    products = entries(tree, "products")
    firsts: dict[str, str] = {}
    paced = {one.value for line in entries(tree, "lines").values() for one in items(line, "stations")}
    for release in releases(tree).values():
        if text(release, "kind") == "saturated":
            made = {name: products[name] for name in made_by(tree, release) if name in products}
            free = {name: node for name, node in made.items() if not _limited(tree, name, node)}
            firsts |= {one: name for name, node in free.items() for one in first_of(node) if one not in paced}
    for name, product in firsts.items():
        station = child(tree, "stations", name)
        if station is not None and isinstance(station.value, dict):
            yield from _endless(station, name, product)


def _limited(tree: Node, name: str, product: Node) -> bool:
    """Whether a loop of cards limits how many jobs of a product there may be from its first station on."""
    firsts = set(first_of(product))
    for card in entries(tree, "cards").values():
        begin, end, asked = (values(card, key) for key in ("from", "to", "products"))
        if (not asked or name in asked) and (not begin or firsts <= begin) and passes(product, begin, end):
            return True
    return False


def _endless(station: Node, name: str, product: str) -> Iterator[Problem]:
    buffer = child(station, "buffer")
    if buffer is None or buffer.value is None or text(buffer) == "unlimited":
        place = station.name_place if buffer is None else buffer.place
        lookup = f"a saturated release into a buffer without limit (first of {shown(product)}) never ends"
        yield problem(place, ("stations", name, "buffer"), lookup, "give the buffer a number of places, such as 1")
    elif isinstance(buffer.value, int) and buffer.value > MOST_AT_ONCE:
        lookup = f"a saturated release would fill {buffer.value:,} places at once; at most {MOST_AT_ONCE:,}"
        yield problem(buffer.place, ("stations", name, "buffer"), lookup, "give the first buffer fewer places")


_HOW = {POISSON: "at random (Poisson)", RENEWAL: "with gaps of their own distribution (renewal)"}


def released(plan: Plan) -> Iterator[Assumption]:
    """(topic, what is assumed) of each source, and of the loops of cards."""
    sources = [source for source in plan.sources if source.kind != INSIDE]
    for source in sources:
        said = _released_how(plan, source)
        if said:
            yield "release", said if len(sources) == 1 else f"{source.name}: {said}"
    for card in plan.cards:
        who = [product.name for product, steps in zip(plan.products, card.steps) if steps]
        whose = "" if len(who) == len(plan.products) else f" of {listed(who)}"
        back = " or ".join(plan.stations[rank].name for rank in card.back)
        end = f"when it leaves {back}" if back else "on the way out"
        yield "cards", f"{card.name}: at most {card.n} jobs{whose} at once; a job gives its card back {end}, in no time"


def _released_how(plan: Plan, source: SourcePlan) -> str:
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

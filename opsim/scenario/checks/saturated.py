"""A saturated source must come to an end: a buffer with a limit, or cards."""

from __future__ import annotations

from collections.abc import Iterator

from opsim.problems import Problem, shown
from opsim.scenario.checks.cards import passes, values
from opsim.scenario.checks.releases import made_by, releases
from opsim.scenario.checks.ways import first_of
from opsim.scenario.positions import Node, child, entries, items, problem, text
from opsim.scenario.schema.release import MOST_AT_ONCE


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
        found = f"a saturated release into a buffer without limit (first of {shown(product)}) never ends"
        yield problem(place, ("stations", name, "buffer"), found, "give the buffer a number of places, such as 1")
    elif isinstance(buffer.value, int) and buffer.value > MOST_AT_ONCE:
        found = f"a saturated release would fill {buffer.value:,} places at once; at most {MOST_AT_ONCE:,}"
        yield problem(buffer.place, ("stations", name, "buffer"), found, "give the first buffer fewer places")

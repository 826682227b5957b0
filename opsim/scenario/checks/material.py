"""The shares of what is released must sum to 1."""

from __future__ import annotations

import math
from collections.abc import Iterator

from opsim.problems import Problem
from opsim.scenario.checks.releases import releases, says_products
from opsim.scenario.fields import to_sum_to_1
from opsim.scenario.positions import Node, child, entries, problem, text


def material_problems(tree: Node) -> Iterator[Problem]:
    """The shares of the products sum to 1, where a source goes by them; one left out counts as 1."""
    if not any(_by_shares(release) for release in releases(tree).values()):
        return
    products = entries(tree, "products")
    nodes = [child(product, "share") for product in products.values()]
    shares = [1.0 if node is None else node.value for node in nodes]
    if not shares or not all(
        isinstance(s, int | float) and not isinstance(s, bool) and math.isfinite(s) for s in shares
    ):
        return
    total = math.fsum(shares)
    if abs(total - 1.0) > 1e-6:
        unsaid = [name for name, node in zip(products, nodes) if node is None]
        hint = f"{unsaid[0]} has no share, which counts as 1" if unsaid and len(products) > 1 else to_sum_to_1(total)
        place = tree.value["products"].name_place
        yield problem(place, ("products",), f"the shares sum to {total:g}; they must sum to 1", hint)


def _by_shares(release: Node) -> bool:
    """Whether a source makes every product by its share."""
    return not says_products(release) and text(release, "kind") not in ("schedule", "base_stock")

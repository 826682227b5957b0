"""What jobs are split into, and the sources of the pieces, which no scenario names."""

from dataclasses import dataclass

from opsim.names import natural_key
from opsim.plan.ranks import Ranks
from opsim.plan.release import INSIDE, SourcePlan
from opsim.plan.stores import Pieces, pieces_of

Most = dict[tuple[str, int], tuple[str, int]]
"""By source and product of a piece: the source of those pieces, and the most of them that one job becomes."""


@dataclass(frozen=True, slots=True)
class SplitPlan:
    """What a unit of a product becomes after its last task at a station.

    sources : (source of the job, product of a piece, source of the pieces, most of them a job), so that the i-th piece
              of the n-th job of a source has the number n x most + i in the source of the pieces, whatever came before
    """

    product: int
    station: int
    pieces: Pieces
    sources: tuple[tuple[int, int, int, int], ...]


def split_sources(scenario, ranks: Ranks, sources: list[SourcePlan]) -> tuple[list[SourcePlan], Most]:
    """A source for each product that jobs of a source are split into, and for what these are split into again."""
    products = {rank: scenario.products[name] for name, rank in ranks.products.items()}
    made: dict[str, SourcePlan] = {}
    most: Most = {}
    todo = list(sources)
    while todo:
        source = todo.pop()
        for rank, n_jobs in _jobs_of_pieces(source, products, ranks):
            name = f"{source.name} > {list(ranks.products)[rank]}"
            most[source.name, rank] = name, max(n_jobs, most.get((source.name, rank), (name, 0))[1])
            if name not in made:
                made[name] = SourcePlan(name, INSIDE, 0.0, "wait", ((rank, 1.0),))
                todo.append(made[name])
    return list(made.values()), most


def plan_splits(scenario, ranks: Ranks, source_ranks: dict[str, int], most: Most) -> tuple[SplitPlan, ...]:
    """Splits in natural order of products and stations."""
    return tuple(
        SplitPlan(rank, ranks.stations[station], pieces, _sources_of(pieces, source_ranks, most))
        for product, rank in ranks.products.items()
        for station, said in sorted(scenario.products[product].split.items(), key=lambda item: natural_key(item[0]))
        for pieces in [pieces_of(said, ranks)]
    )


def _jobs_of_pieces(source: SourcePlan, products, ranks: Ranks):
    """(product, jobs) of what a job of a source may become: pieces in lots of their product, the last one smaller."""
    for rank, _ in source.mix:
        for pieces in products[rank].split.values():
            for name, n in pieces.items():
                piece = ranks.products[name]
                yield piece, -(-n * products[rank].lot // products[piece].lot)


def _sources_of(pieces: Pieces, ranks: dict[str, int], most: Most) -> tuple[tuple[int, int, int, int], ...]:
    wanted = {product for product, _ in pieces}
    found = ((ranks[source], product, ranks[name], n) for (source, product), (name, n) in most.items())
    return tuple(sorted(one for one in found if one[1] in wanted))

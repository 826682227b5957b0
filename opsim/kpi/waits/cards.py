"""Which jobs have a card of a loop: those that entered it and have not left it."""

import numpy as np

from opsim.log import JOB_KINDS, EventLog
from opsim.plan import Plan
from opsim.plan.card_ways import has_card


def card_holders(log: EventLog, plan: Plan, jobs: list[int]) -> list[set[int]]:
    """Of each loop the jobs that had a card of it when the run ended, among those that were inside then."""
    if not plan.cards:
        return []
    rows = np.flatnonzero(np.isin(log["kind"], JOB_KINDS) & (log["station"] >= 0) & np.isin(log["job"], jobs))
    rows = rows[np.lexsort([log["end_s"][rows], log["job"][rows]])]
    ways: dict[int, list[int]] = {}
    products: dict[int, int] = {}
    for job, product, station in zip(*(log[column][rows].tolist() for column in ("job", "product", "station"))):
        ways.setdefault(job, []).append(station)
        products[job] = product
    return [{job for job, way in ways.items() if has_card(card, products[job], plan, way)[-1]} for card in plan.cards]

"""Pull: closed lines of Hopp & Spearman (CONWIP), and a store that is kept filled (base stock).

How the models of the books are said here:
worst case : all jobs are one lot, which is worked on and moved as a whole.
base stock : an order is a job that takes a piece out of the store, at a counter that always has room; who finds a piece
             is gone at once, so the fill rate is the share of orders that stay no time, the backlog the orders inside.
"""

from known_answers.case import Case

_CONWIP = "CONWIP line [2, 2, 2, 2]"
_PENNY = "Hopp-Spearman laws, Penny Fab Two"
_BASE_STOCK = "base stock, one exponential machine"


def _rate(file: str, variant: str, *expected: str, few: int = 12) -> Case:
    return Case(file, variant, "throughput_per_h", expected, scale=3600.0, few=few)


CASES = (
    *(_rate("conwip", f"w{w}", _CONWIP, "throughput", str(w)) for w in (1, 2, 3, 4, 8, 12)),
    *(_rate("penny_fab", f"w{w}", _PENNY, "best", str(w), few=2) for w in (4, 8, 12)),
    _rate("penny_fab", "pile", _PENNY, "worst", few=2),
    Case("base_stock", "base", "filled_at_once", (_BASE_STOCK, "fill_rate"), most_half_width=0.02, few=36),
    Case("base_stock", "base", "orders_waiting", (_BASE_STOCK, "mean_backlog"), most_half_width=0.05, few=36),
    Case("base_stock", "base", "pieces_in_stock", (_BASE_STOCK, "mean_stock"), most_half_width=0.02, few=36),
)

"""How a stretch of a Gantt chart looks: jobs by product, what else stands at stations, and what people do."""

from __future__ import annotations

from opsim.plan import Plan
from opsim.report.bars import Bar, Look
from opsim.report.gantt_rows import Stretch
from opsim.report.palette import OTHER, STATES, WORDS
from opsim.report.rough import rough
from opsim.report.time_axis import at_ms

PRODUCTS = (
    *(("#0072B2", "#ffffff"), ("#56B4E9", "#111111"), ("#009E73", "#ffffff"), ("#CC79A7", "#111111")),
    *(("#7E6BA8", "#ffffff"), ("#F0E442", "#111111"), ("#5c6570", "#ffffff"), ("#B5D6A5", "#111111")),
)
OF_STATION = {
    "setup": Look("set-up", "#8A6D3B", "#ffffff", "x"),
    "blocked": Look("done, no room behind it", "#D55E00", "#ffffff", "/"),
    "held": Look("stands there and waits", "#E69F00", "#111111", "."),
    "down": Look(WORDS["down"], "#7a1f1f", "#ffffff", "\\"),
    "repair": Look(WORDS["repair"], "#a05a5a", "#ffffff", "\\"),
    "closed": Look("closed", "#c9c4bb", "#111111"),
}
OF_WORKER = {
    "work": Look("people at work", "#43536b"),
    "setup": Look("people setting up", "#8A6D3B", "#ffffff", "x"),
    "walk": Look("walking", "#9aa1a9", "#111111", "/"),
    "break": Look("in a break", "#b9a7d6", "#111111"),
    "meeting": Look("in a meeting", "#7E6BA8", "#ffffff", "\\"),
    "held": Look("stands by a blocked job", "#CC79A7", "#111111", "/"),
    "team": Look("waits for the team", "#B58BB0", "#111111", "."),
    "absent": Look("absent", "#d6d6d6", "#111111", "x"),
}
CAUSES = {
    "worker": "waits for a worker",
    "takt": "waits for the line to move",
    "line_stop": "the line stands",
    "parts": "waits for parts",
    "tool": "waits for a tool",
    "place": "waits for a place downstream",
    "pickup": "waits for a transporter",
    "away": "waits for who began it",
    "down": "the station is down",
    "setup": "waits for the set-up",
    "team": "waits for the team",
}


def products(plan: Plan) -> dict[int, Look]:
    """A colour a product, with dots where they come round again."""
    n = len(PRODUCTS)
    return {
        rank: Look(product.name, *PRODUCTS[rank % n], pattern="." if rank // n % 2 else "")
        for rank, product in enumerate(plan.products)
    }


def of_station(one: Stretch, plan: Plan, row: int, looks: dict[int, Look]) -> Bar:
    """A bar of what is on a lane of a station, or of the station as a whole."""
    whole = one.what in ("down", "repair", "closed")
    thick = 0.8 if whole else 0.8 / one.lanes
    middle = row if whole else row - 0.4 + 0.8 * (one.lane + 0.5) / one.lanes
    look = looks[one.product] if one.what == "work" else OF_STATION[one.what]
    name = plan.stations[one.row].name
    job = f", job {one.job}" if one.job >= 0 else ""
    cause = f", {CAUSES[one.cause]}" if one.cause in CAUSES else ""
    text = str(one.job) if one.what == "work" and one.lanes == 1 else ""
    return _bar(look, middle, one, plan, text, f"{name}{job}{cause}", thick)


def of_worker(one: Stretch, plan: Plan, row: int) -> Bar:
    """A bar of what somebody does."""
    station = plan.stations[one.station].name if one.station >= 0 else ""
    look = OF_WORKER.get(one.what) or Look(WORDS.get(one.what, one.what), *STATES.get(one.what, OTHER))
    job = f"job {one.job}" if one.job >= 0 else ""
    at = {"walk": "to "}.get(one.what, "") + station if station else ""
    text = station if one.what in ("work", "setup") else ""
    return _bar(look, row, one, plan, text, ", ".join(filter(None, (plan.workers[one.row].name, at, job))), 0.8)


def _bar(look: Look, row: float, one: Stretch, plan: Plan, text: str, said: str, thick: float) -> Bar:
    begin_ms, end_ms = at_ms(plan.start_s, [one.start_s, one.end_s]).tolist()
    lasts = rough(one.end_s - one.start_s)
    return Bar(look, row, begin_ms, end_ms - begin_ms, text, f"{said}, {lasts}", round(thick, 4))

"""What the assumption sheet says of the flow of material: transport, stations, allocation, buffers, release."""

from collections.abc import Iterator

from opsim.names import listed
from opsim.plan import Plan
from opsim.plan.station import STATION
from opsim.study.assumed.assignment import assignment, qualities
from opsim.study.assumed.crews import crews
from opsim.study.assumed.lines import lines
from opsim.study.assumed.released import released
from opsim.study.assumed.station_model import by_themselves, station_model, vehicles
from opsim.study.assumed.stopped import stopped

_IDLE = {
    "stay": "stay where they are",
    "home": "walk home, and can be called again when they are there",
    "patrol": "walk round their stations and serve only where they stand",
}


def flow(loaded, plan: Plan) -> Iterator[tuple[str, str]]:
    """(topic, what is assumed), most weighty first."""
    yield from _transport(plan)
    yield from station_model(plan)
    yield from stopped(plan)
    if len(plan.workers) > sum(len(crew.workers) for crew in plan.crews):
        rule, blocked = plan.rule.replace("_", " "), plan.when_blocked
        chosen = "chosen" if "allocation.rule" in loaded.given else "default"
        yield "allocation", f"free workers go by {rule} ({chosen}); with a blocked job a worker is {blocked}"
        yield "allocation", f"idle workers {_IDLE[plan.idle]}"
        yield from assignment(plan)
        yield from qualities(plan)
    yield from crews(loaded, plan)
    yield from lines(plan)
    paced = {rank for line in plan.lines for rank in line.stations}
    stations = [one for rank, one in enumerate(plan.stations) if one.kind == STATION and rank not in paced]
    unlimited = [station.name for station in stations if station.buffer == float("inf")]
    if unlimited:
        yield "buffers", f"unlimited in front of {listed(unlimited)}"
    yield from released(plan)


def _transport(plan: Plan) -> Iterator[tuple[str, str]]:
    carried = [product.name for product in plan.products if product.carried]
    if carried:
        yield (
            "transport",
            f"whoever did the last task at a station carries {listed(carried)} to the next at walking speed, "
            "unhampered by the load, and waits with it while that is full; after an automatic task it passes without "
            "time",
        )
    yield from _limits(plan)
    yield from vehicles(plan)
    if len(carried) < len(plan.products) and by_themselves(plan):
        others = carried or plan.transporters or plan.conveyors
        yield "transport", f"{'other jobs' if others else 'jobs'} pass between stations without time"


def _limits(plan: Plan) -> Iterator[tuple[str, str]]:
    """What is carried at once, where workers or products say something about it."""
    carried = [product for product in plan.products if product.carried]
    limited = [worker.name for worker in plan.workers if worker.most_load_kg is not None]
    weighed = [product.name for product in carried if product.mass_kg is not None]
    if limited and weighed:
        yield (
            "transport",
            f"{listed(limited)}: as many walks as the load limit asks for, with whole pieces of {listed(weighed)}",
        )
    unweighed = [product.name for product in carried if product.mass_kg is None]
    if limited and unweighed:
        yield "transport", f"{listed(unweighed)}: no mass is given, and anybody carries all of a job at once"
    unlimited = [worker.name for worker in plan.workers if worker.most_load_kg is None]
    if weighed and unlimited:
        yield "transport", f"{listed(unlimited)}: no load limit is given; they carry all of a job at once"

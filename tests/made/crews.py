"""Who works together on made floors: crews, paced lines, rotation; ``made.assignment`` has who goes where first."""

from __future__ import annotations

from collections.abc import Callable

from made.assignment import choice_of_work, floaters, levels, limited, station_priorities, work_sharing, zones
from made.floors import Floor
from made.ways import plain_way, way_of_its_own


def brigade(floor: Floor) -> None:
    _crew(floor, "bucket_brigade")


def rabbits(floor: Floor) -> None:
    _crew(floor, "rabbit_chase")


def _crew(floor: Floor, kind: str) -> None:
    steps = plain_way(floor, kind[0])
    names = [f"{kind[:2]}{n}" for n in range(floor.pick.whole(2, 3))]
    _more_workers(floor, names, steps)
    floor["crews"][kind] = {"kind": kind, "stations": steps, "workers": names}


def indexed_line(floor: Floor) -> None:
    _line(floor, {"kind": "indexed"})


def moving_line(floor: Floor) -> None:
    _line(
        floor,
        {"kind": "moving", "length": "4 m", **{key: f"{floor.pick.whole(0, 2)} m" for key in ("drift", "upstream")}},
    )


def _line(floor: Floor, line: dict) -> None:
    pick = floor.pick
    steps = way_of_its_own(floor, line["kind"][0])
    floor["flow"].pop("blocking", None)
    for step in steps:
        del floor["stations"][step]["buffer"]
    andon = {"andon": {"workers": ["w0"], "at": f"{pick.whole(5, 14)} s", "does": pick.one_of(["take_over", "help"])}}
    unfinished = pick.one_of(["stop", "send_on"])
    floor["lines"][line["kind"]] = {
        **line,
        "stations": steps,
        "takt": f"{pick.whole(15, 40)} s",
        "unfinished": unfinished,
    }
    if pick.whole(0, 1):
        floor["lines"][line["kind"]].update(andon)


def rotation(floor: Floor) -> None:
    """Two workers change posts by the clock or by count; both have the skills of all posts."""
    posts = [[station] for station in floor.pick.shuffled(floor.stations)[:2]]
    _more_workers(floor, ["r0", "r1"], list(floor["stations"]))
    how = floor.pick.one_of([{"every": "4 min"}, {"after": 5}, {"every": "5 min", "rule": "least_time"}])
    floor["rotations"]["turns"] = {"workers": ["r0", "r1"], "posts": posts, **how}


def _more_workers(floor: Floor, names: list[str], stations: list[str]) -> None:
    """Workers with a shift who can work at some stations; nobody patrols then."""
    if floor["allocation"]["idle"] == "patrol":
        floor["allocation"]["idle"] = "stay"
        floor["allocation"].pop("serve", None)
        for worker in floor["workers"].values():
            del worker["patrol"]
    for name in names:
        floor.add_worker(name, everywhere=True)
        skills = {station: floor.pick.one_of([0.8, 1.0, 1.25]) for station in stations}
        floor["workers"][name].update(skills=skills, shift=floor.pick.one_of(list(floor["shifts"])))


CREWS: dict[str, Callable[[Floor], None]] = {
    block.__name__: block
    for block in (
        *(choice_of_work, levels, zones, floaters, station_priorities, limited, work_sharing),
        *(brigade, rabbits, indexed_line, moving_line, rotation),
    )
}
"""By name, in the order in which they are put in."""

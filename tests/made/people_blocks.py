"""People on made floors: shifts, pauses, rules of interruption, absence, overtime, hours of stations and sources.

``made.crews`` has who works where. The floor lasts an hour, so that both shifts and a midnight fit in; times are whole
seconds and pauses begin on whole minutes, so that they meet ends of tasks now and then.
"""

from __future__ import annotations

from collections.abc import Callable

from made.blocks import BLOCKS
from made.crews import CREWS
from made.floors import PLACES, Floor
from made.two_days import for_two_days

RULES = ("finish", "finish_job", "resume", "resume_any", *3 * ("hand_over",), "restart")
"""Rules of interruption; for a hand-over somebody has to be free, so it is drawn more often."""
STARTS = {"Mon 06:00": 360, "Tue 13:30": 810, "Sun 23:30": 1410}
"""Where an hour begins, and at which minute of its day."""
PATTERNS = (((0, 30), (30, 60)), ((0, 35), (25, 60)), ((2, 25), (32, 58)), ((-10, 40), (20, 80)), ((1, 59), (10, 50)))
"""From and to of two shifts in minutes: one after the other, overlapping, with a gap, longer than the hour, nested."""
ALWAYS = ("shifts", "breaks")


class PeopleFloor(Floor):
    """A floor of one hour, with tasks of six to thirty seconds; on a third of floors they end where pauses begin.

    begins_min : the minute of the day at which it begins; slots : minutes in each shift at which a pause may begin
    """

    def __init__(self, pick):
        super().__init__(pick)
        self.slots: dict[str, list[int]] = {}
        start = pick.one_of([*STARTS, "Mon 06:00"])
        self.begins_min = STARTS[start]
        self.scenario["run"] = {"start": start, "horizon": "3600 s", "warm_up": "60 s", "seed": 3}
        step_s = pick.one_of([1, 1, 10])
        for name, task in self["tasks"].items():
            task["fixed"] = "4 s" if name == "m" else f"{step_s * pick.whole(-(-6 // step_s), 30 // step_s)} s"
            if pick.whole(0, 2):
                task.pop("automatic", None)
        for station in self["stations"].values():
            station["buffer"] = pick.whole(2, 9)
        if "every" in self.main:
            self.main["every"] = "15 s" if self.main["kind"] == "poisson" else {"fixed": "16 s"}

    def clock(self, minute: int) -> str:
        """The time of day at a minute of the run, such as ``06:05``."""
        of_day = (self.begins_min + minute) % 1440
        return f"{of_day // 60:02d}:{of_day % 60:02d}"

    def hours(self, from_min: int, to_min: int) -> dict:
        return {"from": self.clock(from_min), "to": self.clock(to_min)}


def shifts(floor: PeopleFloor) -> None:
    """Two shifts with rules of their own; who is not in either is in both, week by week, or always there."""
    pick = floor.pick
    for name, (begins, ends) in zip(("early", "late"), pick.one_of(PATTERNS)):
        floor.slots[name] = list(pick.shuffled(range(begins, ends - 3, 4)))
        floor["shifts"][name] = floor.hours(begins, ends) | {"at_end": pick.one_of(RULES)}
    for worker in floor["workers"].values():
        shift = pick.one_of(["early", "early", "early", "late", "late", "late", ["early", "late"], None])
        if shift is not None:
            worker.update(shift=shift, home=pick.one_of(list(PLACES)))


def breaks(floor: PeopleFloor) -> None:
    """Two to four in each shift, some at its very beginning, some one after the other."""
    pick = floor.pick
    for name, shift in floor["shifts"].items():
        named = {f"b{n}": _pause(floor, name) for n in range(pick.whole(2, 4))}
        shift.update(breaks=named, at_break=pick.one_of(RULES))


def meetings(floor: PeopleFloor) -> None:
    name = floor.pick.one_of(["early", "late"])
    floor["shifts"][name]["meetings"] = {"board": _pause(floor, name)}


def _pause(floor: PeopleFloor, shift: str) -> dict:
    """In one of the shift's slots of four minutes that are left."""
    pause = {"at": floor.clock(floor.slots[shift].pop()), "lasts": f"{floor.pick.whole(1, 4)} min"}
    return pause | ({"place": floor.pick.one_of(["p1", "p2"])} if floor.pick.whole(0, 2) == 0 else {})


def task_rules(floor: PeopleFloor) -> None:
    """Tasks with rules of their own, which come before those of the shift."""
    for name in floor.pick.shuffled([task for task in floor["tasks"] if task != "change"])[:2]:
        if floor["tasks"][name].get("automatic") is not True:
            floor["tasks"][name]["interruption"] = floor.pick.one_of(RULES)


def absence(floor: PeopleFloor) -> None:
    for worker in floor["workers"].values():
        if "shift" in worker:
            worker["absence"] = floor.pick.one_of([0, 0.2, 0.5])


def overtime(floor: PeopleFloor) -> None:
    """Not in the early shift of who changes shifts by the week: there it might last into the late one."""
    both = any(isinstance(worker.get("shift"), list) for worker in floor["workers"].values())
    for name, shift in floor["shifts"].items():
        if name == "late" or not both:
            shift["overtime"] = {"most": f"{floor.pick.whole(1, 20)} min"}


def station_hours(floor: PeopleFloor) -> None:
    station = floor.some_station
    station["shift"] = floor.pick.one_of(["early", "late"])
    station["at_close"] = floor.pick.one_of(["finish", "resume"])


def source_hours(floor: PeopleFloor) -> None:
    if floor.main["kind"] != "schedule":
        floor.main["shift"] = floor.pick.one_of(["early", "late"])


PEOPLE: dict[str, Callable[[PeopleFloor], None]] = {
    block.__name__: block
    for block in (shifts, breaks, meetings, absence, overtime, station_hours, source_hours, task_rules)
}
"""By name, in the order in which they are put in: after the blocks of material and stations, before crews."""


def people_floor_with(pick, wanted: list[str]) -> dict:
    """A made scenario with shifts and breaks and some of the blocks, as values; one of seven lasts for 36 hours."""
    floor = PeopleFloor(pick)
    for name, put in {**BLOCKS, **PEOPLE, **CREWS}.items():
        if name in wanted or name in ALWAYS:
            put(floor)
    return floor.values if pick.whole(0, 6) else for_two_days(floor.values, floor.begins_min)

"""Who works, and with what in his hands: tools, holds, teams and attended runs, where tasks ask for them."""

from functools import partial

from opsim.engine.simpy_engine import tools
from opsim.engine.simpy_engine.attended import attend
from opsim.engine.simpy_engine.crib import Crib
from opsim.engine.simpy_engine.floor import Floor
from opsim.engine.simpy_engine.holds import Holds
from opsim.engine.simpy_engine.state import Job, Station, Worker
from opsim.engine.simpy_engine.teams import Teams
from opsim.engine.simpy_engine.tools import at_hand, for_task, tasks_done
from opsim.plan.tasks import TaskPlan

ACT = READY = 50
"""Among the ways to begin a task: after those that look at who begins it."""
ORDER = 5
"""Among what is asked when an operation is done: tools are given back before a job is looked at, or is split."""


class Hands:
    """What the tasks of a floor ask for beyond a worker alone."""

    def __init__(self, floor: Floor, crib: Crib | None):
        tasks = floor.plan.tasks
        self.crib = crib
        self.holds = Holds(floor, crib) if crib is not None and any(task.hold for task in tasks) else None
        self.teams = Teams(floor, crib) if any(task.team > 1 for task in tasks) else None

    def ready(self, floor: Floor, job: Job) -> bool:
        """Whether the task a job has come to may begin: its tools are there, and no team is wanted."""
        if self.crib is not None and not for_task(self.crib, floor, job):
            return False
        if self.teams is not None and _task(floor, job).team > 1:
            self.teams.call(floor, job)
            return False
        return True

    def act(self, floor: Floor, job: Job, worker: Worker) -> bool:
        """Another way to begin a task than that of a worker alone; False where it is none of these."""
        if job.setup_task >= 0:
            return False
        task = _task(floor, job)
        if self.crib is not None and task.needs and not self._with_tools(floor, job, self.crib):
            return False
        if task.team > 1 and self.teams is not None:
            return self.teams.act(floor, job, worker)
        if task.hold is not None and self.holds is not None:
            return self.holds.act(floor, job, worker)
        return task.attended and attend(floor, job, worker)

    def _with_tools(self, floor: Floor, job: Job, crib: Crib) -> bool:
        """Whether somebody who is there can begin with his tools; where the station stands still, they go back."""
        station = job.station
        if station.down and job.team is None:
            crib.break_off(floor, job)
            return False
        at_hand(crib, floor, job)
        return True

    def acted(self, floor: Floor, job: Job, worker: Worker) -> bool:
        """What follows where a stretch of such a task is over; False where it was the performance's end."""
        if self.teams is not None and job.team is not None:
            return self.teams.acted(floor, job, worker)
        return self.holds is not None and job.setup_task < 0 and self.holds.acted(floor, job, worker)


def install(floor: Floor) -> None:
    """Hang the hands on the stations with a task that asks for more than a worker alone."""
    crib = tools.install(floor)
    wanting = [station for station in floor.stations if any(_asks(floor.plan.tasks[task]) for task in station.tasks)]
    if not wanting:
        return
    hands = Hands(floor, crib)
    for station in wanting:
        _hang(hands, floor, station)


def _hang(hands: Hands, floor: Floor, station: Station) -> None:
    here = [floor.plan.tasks[task] for task in station.tasks]
    if any(task.needs or task.team > 1 for task in here):
        station.add_ready(READY, hands.ready)
    if any(task.needs for task in here) and hands.crib is not None:
        station.add_after(ORDER, partial(tasks_done, hands.crib))
    if any(_asks(task) for task in here):
        station.add_act(ACT, hands.act)
        station.acted = hands.acted
    if hands.crib is not None:
        station.sent, station.before = hands.crib.sent, hands.crib.before


def _asks(task: TaskPlan) -> bool:
    return bool(task.needs) or task.hold is not None or task.team > 1 or task.attended


def _task(floor: Floor, job: Job) -> TaskPlan:
    return floor.plan.tasks[job.station.tasks[job.task_position]]

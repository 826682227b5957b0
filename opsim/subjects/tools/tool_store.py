"""The crib: where tools are taken from and given back to, and who waits for which."""

from __future__ import annotations

from typing import Any

from opsim.engine.floor.event_list import wake
from opsim.engine.floor.floor_state import Floor
from opsim.engine.floor.log_rows import job_now
from opsim.engine.floor.machine import NOTHING, List, drop, fresh, give_back, index_of, inlined, step
from opsim.engine.floor.state import Job, Station
from opsim.log import HELD, NO_TOOL
from opsim.subjects.routes.routing import claim_at, give_up_claims
from opsim.subjects.stations.station import quiet
from opsim.subjects.tools.tool_grips import (
    Crib,
    Grip,
    JobTools,
    Want,
    grip_at,
    is_free,
    is_known,
    log_grip,
    log_wait,
    tools_of,
)

AT_STATION, IN_HAND = -1, -2
"""What a job has tools for, besides the tasks at its station by their position: the station itself, a hold."""
_new_grip, _forget_grip, _forget_want = fresh(Grip), give_back(Grip), give_back(Want)


@step
def take(floor: Floor, job: Job, want: Want) -> bool:
    """The job takes all the tools it wants; False where it has to wait for them, all together."""
    if grip_at(job, want.purpose) >= 0:
        return True
    free = is_free(floor.crib, want.n_needs, want.needs)
    if free and not _first_is_another(floor, job, want):
        if want.at_once:
            grip(floor, job, want)
        return True
    wait(floor, job, want)
    if free:
        _stir(floor)
    return False


@step
def call_with(floor: Floor, job: Job, want: Want) -> None:
    """The job calls for a worker, with tools that are free now; somebody else may have them before he sets out."""
    crib, mine = floor.crib, tools_of(floor, job)
    job.with_tools = 1
    mine.known = 1
    _since(floor, mine, want.purpose)
    if mine.calling:  # it keeps its place among those who call
        crib.calling[index_of(crib.calling, mine.calling)] = want
        crib.spent.append(mine.calling)
    else:
        crib.calling.append(want)
    mine.calling = want


@step
def before(floor: Floor, job: Job) -> None:
    """Who calls first at a station, and has waited longer for tools that a job calls for too: ``crib.found``, the
    longest wait first.
    """
    crib, mine = floor.crib, job.block.tools.calling
    _claim(floor, mine)
    crib.found.clear()
    for want in crib.calling:
        if want is mine or not _is_short(crib, mine, want):
            continue
        calling = want.job.station.calling
        if calling and calling[0].job is want.job:
            _claim(floor, want)
            if _has_waited_longer(want, mine):
                _insort(floor, crib.found, want)


@step
def sent(floor: Floor, station: Station, job: Job) -> None:
    """A worker sets out, and the tools with him."""
    want = job.block.tools.calling
    drop(floor.crib.calling, want)
    job.block.tools.calling = NOTHING
    job.with_tools = 0
    grip(floor, job, want)
    floor.crib.spent.append(want)


@step
def grip(floor: Floor, job: Job, want: Want) -> None:
    """The tools are the job's; whoever calls for a worker with them calls no more, and waits."""
    crib, mine = floor.crib, tools_of(floor, job)
    for i in range(want.n_needs):
        crib.free[want.needs[2 * i]] -= want.needs[2 * i + 1]
    at = grip_at(job, want.purpose)
    if at < 0:
        at = len(mine.grips)
        mine.grips.append(_new_grip(floor))
    made = mine.grips[at]
    made.purpose, made.n_needs, made.needs, made.task = want.purpose, want.n_needs, want.needs, want.task
    made.since_s, made.station, made.operation = floor.now, job.station.rank, job.operation
    mine.known = 1
    _want_no_more(mine, want.purpose)
    at = 0
    while at < len(crib.calling):
        unmet = crib.calling[at]
        if is_free(crib, unmet.n_needs, unmet.needs):
            at += 1
        else:
            _call_no_more(floor, unmet)


@step
def put_back(floor: Floor, job: Job, purpose: int) -> None:
    """The job gives back what it had for something, if it had."""
    crib, at = floor.crib, grip_at(job, purpose)
    if at < 0:
        return
    found = job.block.tools.grips[at]
    del job.block.tools.grips[at]
    log_grip(floor, job, found)
    for i in range(found.n_needs):
        tool = found.needs[2 * i]
        if crib.shared[tool]:
            crib.returned[tool] += found.needs[2 * i + 1]
        else:
            crib.free[tool] += found.needs[2 * i + 1]
    _forget_grip(floor, found)
    if crib.waiting:
        _stir(floor)


@step
def put_back_tasks(floor: Floor, job: Job, keep: int) -> None:
    """The job gives back the tools of its tasks, but those of the one it has come to (IN_HAND: of all)."""
    if not job.block.tools:
        return
    grips, at = job.block.tools.grips, 0
    while at < len(grips):
        purpose = grips[at].purpose
        if purpose >= 0 and purpose != keep:
            put_back(floor, job, purpose)
        else:
            at += 1


@step
def break_off(floor: Floor, subject: Any, job: Job) -> None:
    """The job's work is broken off: what was in hand for it is put back, what the station needs stays."""
    if job is floor.handed_over:
        return
    _call_back(floor, job, IN_HAND, IN_HAND)
    put_back_tasks(floor, job, IN_HAND)
    put_back(floor, job, IN_HAND)


@step
def call_off_tools(floor: Floor, subject: Any, job: Job) -> bool:
    """The job, which may not begin yet, waits for the tools of its task no more; True where it did."""
    return _call_back(floor, job, 0, job.station.n_tasks - 1)


@step
def _call_back(floor: Floor, job: Job, least: int, most: int) -> bool:
    """The job waits no more for tools for some purposes; True where it did."""
    waiting, at, found = floor.crib.waiting, 0, False
    while at < len(waiting):
        want = waiting[at]
        if want.job is job and least <= want.purpose and want.purpose <= most:
            del waiting[at]
            floor.crib.spent.append(want)
            _want_no_more(job.block.tools, want.purpose)
            log_wait(floor, job, want.task)
            found = True
        else:
            at += 1
    return found


@step
def leave(floor: Floor, subject: Any, job: Job, station: Station) -> None:
    """The job leaves its station, or loses its server: it has nothing any more, and waits for nothing."""
    mine, crib = job.block.tools, floor.crib
    if not is_known(job):
        return
    mine.known = 0
    for at in range(len(crib.waiting) - 1, -1, -1):
        if crib.waiting[at].job is job:
            crib.spent.append(crib.waiting[at])
            del crib.waiting[at]
    if mine.calling:
        drop(crib.calling, mine.calling)
        crib.spent.append(mine.calling)
        mine.calling = NOTHING
    job.with_tools = 0
    while mine.grips:
        put_back(floor, job, mine.grips[0].purpose)
    mine.wanted.clear()
    mine.since_s.clear()


@step
def pass_on(floor: Floor, job: Job, other: Job) -> None:
    """What the station needs is another job's from now on."""
    at = grip_at(job, AT_STATION)
    passed = job.block.tools.grips[at]
    del job.block.tools.grips[at]
    log_grip(floor, job, passed)
    mine = tools_of(floor, other)
    mine.known = 1
    passed.since_s, passed.operation = floor.now, other.operation
    mine.grips.append(passed)


@step
def give_out(floor: Floor, subject: Any) -> bool:
    """What was given back goes to who waits: the first that can have all he wants. True where somebody got it."""
    crib = floor.crib
    while crib.spent:
        _forget_want(floor, crib.spent.pop())
    if not crib.changed:
        return False
    crib.changed = 0
    given = False
    crib.asked.clear()
    for claim in crib.waiting:
        crib.asked.append(claim)
    for want in crib.asked:
        if is_free(crib, want.n_needs, want.needs) and want in crib.waiting:
            _give(floor, want)
            given = True
    return given


@step
def _give(floor: Floor, want: Want) -> None:
    """Who waits has the tools he wants, and goes on."""
    drop(floor.crib.waiting, want)
    floor.crib.spent.append(want)
    log_wait(floor, want.job, want.task)
    if want.at_once:
        grip(floor, want.job, want)
    want.go_on_line(floor, want)


@step
def close_crib(floor: Floor, subject: Any) -> bool:
    """Write what is open at the horizon."""
    waiting, job = floor.crib.waiting, floor.first_job
    for one in waiting:
        log_wait(floor, one.job, one.task)
    while job:
        if job.block.tools:
            for other in job.block.tools.grips:
                log_grip(floor, job, other)
        job = job.next_on_floor
    return True


@inlined
def _stir(floor: Floor) -> None:
    """Somebody who waits may have what he wants: to be seen in this instant."""
    floor.crib.changed = 1
    wake(floor)


@inlined
def _since(floor: Floor, mine: JobTools, purpose: int) -> float:
    """Since when the job wants tools for a purpose: from now on, where it did not before."""
    at = index_of(mine.wanted, purpose)
    if at < 0:
        at = len(mine.wanted)
        mine.wanted.append(purpose)
        mine.since_s.append(floor.now)
    return mine.since_s[at]


@inlined
def _want_no_more(mine: JobTools, purpose: int) -> None:
    at = index_of(mine.wanted, purpose)
    if at >= 0:
        del mine.wanted[at]
        del mine.since_s[at]


@inlined
def _claim(floor: Floor, want: Want) -> None:
    """The claim of a job that wants tools as it is now; since now, where it has not waited for them."""
    want.before, want.since_s = -want.job.priority, floor.now
    if want.job.block.tools:
        mine = want.job.block.tools
        at = index_of(mine.wanted, want.purpose)
        if at >= 0:
            want.since_s = mine.since_s[at]


@inlined
def _has_waited_longer(one: Want, other: Want) -> bool:
    if one.before != other.before:
        return one.before < other.before
    return one.since_s < other.since_s


@inlined
def _comes_first(one: Want, other: Want) -> bool:
    """Whether one is served before another."""
    if one.before != other.before or one.since_s != other.since_s:
        return _has_waited_longer(one, other)
    return one.job.number < other.job.number


@inlined
def _insort(floor: Floor, wants: List[Want], want: Want) -> None:
    at = len(wants)
    while at > 0 and _comes_first(want, wants[at - 1]):
        at -= 1
    wants.insert(at, want)


@inlined
def _is_short(crib: Crib, mine: Want, want: Want) -> bool:
    """Whether there is too little of a tool for both."""
    for i in range(want.n_needs):
        for j in range(mine.n_needs):
            tool = want.needs[2 * i]
            if tool == mine.needs[2 * j] and crib.free[tool] < mine.needs[2 * j + 1] + want.needs[2 * i + 1]:
                return True
    return False


@inlined
def _shares_a_tool(one: Want, other: Want) -> bool:
    for i in range(one.n_needs):
        for j in range(other.n_needs):
            if one.needs[2 * i] == other.needs[2 * j]:
                return True
    return False


@inlined
def _first_is_another(floor: Floor, job: Job, want: Want) -> bool:
    """Whether one of these tools goes to somebody who waits, and is to have it in this instant."""
    crib = floor.crib
    if not crib.waiting:
        return False
    _claim(floor, want)
    for other in crib.waiting:
        if not _comes_first(other, want):
            return False
        if is_free(crib, other.n_needs, other.needs) and _shares_a_tool(other, want):
            return True
    return False


@step
def wait(floor: Floor, job: Job, want: Want) -> None:
    """The job waits for the tools it wants."""
    job_now(floor, job, HELD, NO_TOOL)
    mine = tools_of(floor, job)
    mine.known = 1
    want.before, want.since_s = -job.priority, _since(floor, mine, want.purpose)
    _insort(floor, floor.crib.waiting, want)


@step
def _call_no_more(floor: Floor, want: Want) -> None:
    """The job, whose tools somebody else has taken, calls for nobody with them, and waits where it did."""
    job = want.job
    drop(floor.crib.calling, want)
    job.block.tools.calling = NOTHING
    job.with_tools = 0
    station = job.station
    if claim_at(station.calling, job) < 0:
        floor.crib.spent.append(want)
        return
    give_up_claims(floor, station.calling, job)
    quiet(floor, station)
    wait(floor, job, want)

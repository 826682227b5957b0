"""What the clock of a paced line shows, where jobs are on a line that moves all the time, and who is done."""

from __future__ import annotations

from opsim.engine.floor.machine import inlined
from opsim.engine.floor.parts.lines import Line
from opsim.engine.floor.parts.state import Job


@inlined
def clock_s(line: Line, now: float) -> float:
    """What it shows at an instant."""
    return line.shown_s + (now - line.runs_since_s) if line.runs else line.shown_s


@inlined
def job_m(line: Line, began_s: float, now: float) -> float:
    """Where a job is that came onto the line when the clock showed ``began_s``."""
    return (clock_s(line, now) - began_s) * line.speed_m_per_s


@inlined
def is_open_at(line: Line, job: Job, at: int) -> bool:
    """Whether something is left to be done of a job at the at-th station of a moving line, where it is."""
    return job.station.line is line and job.block.line_open == at + 1


@inlined
def is_open(line: Line, job: Job) -> bool:
    """Whether something is left to be done of a job at its station."""
    if line.moves:
        return is_open_at(line, job, job.station.line_at)
    return job in job.station.seated and job not in line.done

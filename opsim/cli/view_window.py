"""A stretch of a run as people say it: '2 h' after its start, or 'Mon 07:30' on its clock."""

from __future__ import annotations

from opsim.week_clock import clock_words, moment_s


def window_s(low: str | None, high: str | None, start_s: float, horizon_s: float) -> tuple[float, float] | None:
    """(low, high) in seconds since the run's start; None where all of it is meant.

    start_s : of the run, seconds after Monday 00:00
    A clock is the first such moment of the run, for ``high`` after ``low``. Raises ValueError with every mistake.
    """
    if low is None and high is None:
        return None
    wrong: list[str] = []
    low_s = 0.0 if low is None else _end("--from", low, start_s, horizon_s, 0.0, wrong)
    high_s = horizon_s if high is None else _end("--to", high, start_s, horizon_s, low_s, wrong)
    if not wrong and low_s >= high_s:
        found = f"{clock_words(low_s, start_s)} and {clock_words(high_s, start_s)}"
        wrong.append(f"--from and --to: found {found}, expected the later one last")
    if wrong:
        raise ValueError("\n".join(wrong))
    return low_s, high_s


def _end(option: str, text: str, start_s: float, horizon_s: float, after_s: float, wrong: list[str]) -> float:
    """One end of a stretch; what is wrong with it is added to ``wrong``."""
    from opsim.problems import shown

    try:
        at_s = moment_s(text, start_s, after_s)
    except ValueError as error:
        wrong.append(f"{option}: {error}")
        return after_s
    if not 0 <= at_s <= horizon_s:
        found = clock_words(at_s, start_s) if at_s >= 0 else "before the start"
        run = f"{clock_words(0.0, start_s)} to {clock_words(horizon_s, start_s)} ({horizon_s / 3600:.4g} h)"
        wrong.append(f"{option}: found {shown(text)} ({found}), expected a moment of the run, {run}")
        return after_s
    return at_s

"""Numbers and KPI names as people read them: a mean shows as many digits as its interval supports.

Amounts as sentences say them: three digits, as finer ones are nobody's plant.

The figures of a long run as words: means, batches, times, and what is doubted in a cell.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import Any

from opsim.kpi.catalogue import CATALOGUE

WITH_HOURS = {
    "throughput_per_h": "Throughput (good units), per scheduled hour",
    "throughput_per_calendar_h": "Throughput (good units), per calendar hour",
}
"""Names where the floor keeps hours."""
ENDINGS = ("_per_calendar_h", "_per_h", "_per_s", "_h", "_s", "_m", "_kg", "_j", "_share")
ROUNDING = 1e-12
"""A half-width below this share of its mean is 0."""
ABSENT = "\N{EN DASH}"
FINEST = 1e-4
"""No digit of a mean is shown that is smaller than this share of it, however narrow its interval."""


def kpi_name(kpi: str, hours: bool = False) -> str:
    """``time_in_system_s`` -> ``Time in system``; an unknown KPI loses its unit's ending and its underscores.

    hours : whether the floor keeps hours, so that what is per hour has to say which
    """
    if hours and kpi in WITH_HOURS:
        return WITH_HOURS[kpi]
    if kpi in CATALOGUE:
        return CATALOGUE[kpi].title
    stem = next((kpi.removesuffix(ending) for ending in ENDINGS if kpi.endswith(ending)), kpi)
    return stem.replace("_", " ").strip().capitalize() or kpi


def is_number(value: Any) -> bool:
    """Whether a figure of the summary is there at all: JSON carries what was not measured as null."""
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)


def digits(value: Any, half_width: Any = None, of: float = 0.0) -> str:
    """``value`` as exact as its half-width says (two digits of it below 355, else one), or with four digits.

    With five digits at most, beyond which nobody's plant is known; of : of what it is a difference, which counts too
    """
    if not is_number(value):
        return ABSENT
    places = _places(value, half_width, of)
    text = f"{value:,.{places}f}"
    return text.lstrip("-") if float(text.replace(",", "")) == 0 else text.replace("-", "\N{MINUS SIGN}")


def half_digits(value: float, half_width: float, of: float = 0.0) -> str:
    """A half-width behind its mean; one that is less than the mean's last digit is rounded up to it."""
    step = 10.0 ** -_places(value, half_width, of)
    return f"{step:g}" if 0 < half_width < step else digits(half_width, half_width)


def _places(value: float, half_width: Any, of: float = 0.0) -> int:
    """Digits behind the point."""
    wide = is_wide(value, half_width)
    scale = max(_last_digit(abs(half_width)), FINEST * max(abs(value), abs(of))) if wide else abs(value) / 1000
    return 0 if scale <= 0 else min(6, max(0, -math.floor(math.log10(scale))))


def is_wide(value: float, half_width: Any) -> bool:
    """Whether there is an interval wider than what adding numbers in another order leaves."""
    return is_number(half_width) and abs(half_width) > ROUNDING * abs(value)


def _last_digit(half_width: float) -> float:
    """The size of the last digit worth showing, after the rule of the Particle Data Group (two digits below 355)."""
    lead = half_width / 10 ** math.floor(math.log10(half_width))
    return half_width / 10 if lead < 3.55 else half_width


def scale_of(unit: str, value: float | None) -> tuple[float, str]:
    """(factor, unit for people): shares as per cent, long times in minutes or hours, long ways in km."""
    if unit == "share":
        return 100.0, "%"
    size = abs(value) if is_number(value) else 0.0  # type: ignore[arg-type]
    if unit == "s" and size >= 2 * 3600:
        return 1 / 3600, "h"
    if unit == "s" and size >= 120:
        return 1 / 60, "min"
    if unit == "m" and size >= 2000:
        return 1 / 1000, "km"
    return 1.0, {"1/h": "per hour", "1/min": "a minute", "deg": "°", "1": ""}.get(unit, unit)


POINTS = "percentage points"


def difference_unit(unit: str) -> str:
    """The unit of a difference, by that for people of what differs: shares in per cent differ by percentage points."""
    return POINTS if unit == "%" else unit


def quantity(value: float | None, unit: str, half_width: float | None = None) -> str:
    """A value with its unit: ``quantity(1384, 's', 60)`` is ``23.1 min``."""
    if not is_number(value):
        return ABSENT
    factor, word = scale_of(unit, value)
    half = None if not is_number(half_width) else half_width * factor  # type: ignore[operator]
    text = digits(value * factor, half)  # type: ignore[operator]
    return f"{text} %" if word == "%" else f"{text} {word}".strip()


def interval_cells(row: Mapping[str, Any], largest: float | None = None) -> dict[str, str]:
    """The cells of one KPI row: mean, interval, half-width in per cent of the mean, unit, n.

    largest : the value that chooses the unit, so that all rows of one figure have the same; by default the row's mean
    """
    mean, low, high, half = (row.get(key) for key in ("mean", "low", "high", "half_width"))
    factor, unit = scale_of(row.get("unit", ""), mean if largest is None else largest)
    has_interval = all(is_number(v) for v in (low, high, half))
    half = half if is_wide(mean, half) else 0.0 if has_interval else None  # type: ignore[arg-type]
    step = half * factor if has_interval else None  # type: ignore[operator]
    text = "one replication" if row.get("n") == 1 else "no interval"
    if not is_number(mean):
        text = "no value in any replication" if not row.get("n") else text
    elif has_interval:
        text = f"{digits(low * factor, step)} to {digits(high * factor, step)}"  # type: ignore[operator]
    relative = 100 * half / abs(mean) if has_interval and mean else None  # type: ignore[operator,arg-type]
    return {
        "mean": digits(mean * factor, step) if is_number(mean) else ABSENT,  # type: ignore[operator]
        "interval": text,
        "relative": ABSENT if relative is None else f"{relative:.2g} %" if relative < 100 else f"{relative:.0f} %",
        "unit": unit,
        "n": f"{row['n']:,}" if is_number(row.get("n")) else ABSENT,
    }


def plus_minus(row: Mapping[str, Any], largest: float | None = None) -> str:
    """``60.1 ± 1.0 per hour``: how the console prints a KPI; ``largest`` chooses the unit for a row of several."""
    factor, unit = scale_of(row.get("unit", ""), row.get("mean") if largest is None else largest)
    if not is_number(row.get("mean")):
        return ABSENT
    half = row.get("half_width")
    if not is_number(half):
        return f"{digits(row['mean'] * factor)} {unit}".strip()
    step = half * factor if is_wide(row["mean"], half) else 0.0  # type: ignore[operator]
    return f"{digits(row['mean'] * factor, step)} ± {half_digits(row['mean'] * factor, step)} {unit}".strip()


def largest_mean(rows: Iterable[Mapping[str, Any]]) -> float | None:
    """The largest mean of some rows, which chooses their common unit."""
    return max((abs(row["mean"]) for row in rows if is_number(row.get("mean"))), default=None)


def clock(start: str, at_s: float) -> str:
    """``clock('Mon 06:00', 1800)`` is ``Mon 06:30``; a start of another form stands beside the hours since it."""
    days = ("Mon", "Tue", "Wed", "Thu", "Fri", "Sat", "Sun")
    parts = str(start).split()
    try:
        hours, minutes = (int(part) for part in parts[1].split(":")[:2])
        minute = days.index(parts[0][:3].capitalize()) * 1440 + hours * 60 + minutes + round(at_s / 60)
    except (ValueError, IndexError):
        return f"{at_s / 3600:g} h after {start}"
    return f"{days[minute // 1440 % 7]} {minute // 60 % 24:02d}:{minute % 60:02d}"


def listing(words: list[str]) -> str:
    """``a, b and c``."""
    return words[0] if len(words) == 1 else ", ".join(words[:-1]) + " and " + words[-1] if words else ""


TRUNK_SHARES = "trunk_flexion_share"


def rough(value: float, unit: str = "s", of: float | None = None) -> str:
    """``rough(1384)`` is ``23.1 min``. of : the amount that chooses the unit, by default the value itself"""
    factor, word = scale_of(unit, value if of is None else of)
    return f"{three_digits(value * factor)} {word}".strip()


def three_digits(value: float) -> str:
    """``9.62``, ``145``, ``1,204``."""
    return f"{value:,.0f}" if abs(value) >= 999.5 else f"{float(f'{value:.3g}'):g}"


def percent(share: float) -> str:
    """A share, in whole per cent."""
    return f"{100 * share:.0f} %"


def largest_of(found: Any) -> float | None:
    """The largest mean of the points, which chooses the unit of everything that is said of the figure."""
    return max((abs(one.mean) for one in found.means if is_number(one.mean)), default=None)


SERIES_NAMES = {
    "throughput_per_h": "Jobs finished",
    "time_in_system_s": "Time in system",
    "work_in_progress": "Jobs inside",
    "jobs_waiting": "Jobs waiting",
    "people_at_work": "People at work",
}


def mean_words(one: Any) -> str:
    """``48.2 ± 1.0 per hour``; jobs and people are not said again behind their number."""
    unit = "" if one.unit in ("jobs", "people") else one.unit
    return plus_minus({"mean": one.batches.mean, "half_width": one.batches.half_width, "unit": unit})


def batch_words(one: Any) -> str:
    """``40 batches of 4.7 h`` or ``10 batches of 916 jobs``."""
    return f"{one.batches.n} batches of {length_words(one)}"


def length_words(one: Any) -> str:
    """How long a batch is, in time or in jobs."""
    if math.isfinite(one.batch_jobs):
        return f"{one.batch_jobs:,.0f} jobs"
    return time_words(one.batch_s)


def time_words(seconds: float) -> str:
    """A time with two digits, in days where it is long: ``4.7 h``, ``12 days``."""
    if seconds >= 3 * 86_400:
        return f"{seconds / 86_400:,.3g} days"
    factor, unit = scale_of("s", seconds)
    return f"{seconds * factor:.2g} {unit}" if seconds * factor < 10 else f"{seconds * factor:.0f} {unit}"


def reasons(one: Any) -> str:
    """In a cell: what speaks against a figure, or ``ok``."""
    words = {
        "unstable": "grows for good",
        "growing": "keeps growing",
        "too_short": "too short",
        "autocorrelated": "batches alike",
        "start_left": "start shows",
        "few_events": "few jobs",
    }
    if one.batches is None:
        return "too few values"
    return ", ".join(words[flag.code] for flag in one.flags) or "ok"

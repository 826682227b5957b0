"""A floor of an hour made into one of 36 hours."""

from __future__ import annotations

import re


def for_two_days(of_an_hour: dict, begins_min: int) -> dict:
    """All times 24 times as long, so that an hour's shifts are a day's and come again on the next."""
    values = _longer(of_an_hour, begins_min)
    values["run"]["horizon"] = "36 h"
    for worker in values["workers"].values():
        if isinstance(worker.get("shift"), list):
            worker["shift"] = worker["shift"][0]  # both may be too long for one person now
    for name, shift in values["shifts"].items():
        if shift["from"] == shift["to"]:
            shift.pop("overtime", None)  # who is always on duty never stays on after it
        elif "overtime" in shift:
            shift["overtime"] = of_an_hour["shifts"][name]["overtime"]
    return values


def _longer(value, begins_min: int):
    if isinstance(value, dict):
        return {key: _longer(of_key, begins_min) for key, of_key in value.items()}
    if isinstance(value, list):
        return [_longer(item, begins_min) for item in value]
    if isinstance(value, str) and (clock := re.fullmatch(r"(\d\d):(\d\d)", value)):
        minute = (int(clock[1]) * 60 + int(clock[2]) - begins_min + 720) % 1440 - 720
        of_day = (begins_min + 24 * minute) % 1440
        return f"{of_day // 60:02d}:{of_day % 60:02d}"
    if isinstance(value, str) and (time := re.fullmatch(r"(\d+) (s|min)", value)):
        return f"{24 * int(time[1])} {time[2]}"
    return value

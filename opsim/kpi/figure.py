"""One figure of one replication."""

from typing import NamedTuple


class Figure(NamedTuple):
    """kpi : its name; subject : worker, station, product or task, empty for the whole; part : a state."""

    kpi: str
    subject: str
    part: str
    unit: str
    value: float

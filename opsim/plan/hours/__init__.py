"""When people and stations are there."""

from opsim.plan.hours.people import Hours

__all__ = ["Hours"]

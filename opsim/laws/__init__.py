"""What must be true of every event log, checked after every run."""

from opsim.laws.audit import CHECKS, BrokenLog, audit, checks_of

__all__ = ["CHECKS", "BrokenLog", "audit", "checks_of"]

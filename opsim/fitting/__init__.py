"""Recorded times -> a distribution of the scenario language, with how well it fits and how far workers differ."""

from opsim.fitting.judge import Fitted, fitted
from opsim.fitting.workers import between_share

__all__ = ["Fitted", "between_share", "fitted"]

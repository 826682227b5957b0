"""Choosing the best of several systems with a promise: plain functions of whatever answers; a study of scenarios."""

from opsim.study.select.constants import dudewicz_dalal_h, rinott_h
from opsim.study.select.kn import kn
from opsim.study.select.ocba import ocba, ocba_allocation
from opsim.study.select.selection import Ask, Limit, Observe, Out, Selection, Stage, each
from opsim.study.select.two_stage import dudewicz_dalal, rinott

__all__ = [
    "Ask",
    "Limit",
    "Observe",
    "Out",
    "Selection",
    "Stage",
    "dudewicz_dalal",
    "dudewicz_dalal_h",
    "each",
    "kn",
    "ocba",
    "ocba_allocation",
    "rinott",
    "rinott_h",
]

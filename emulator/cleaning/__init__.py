"""Cleaning: what is wrong with a recording is found, counted, and mended where that can be done honestly."""

from __future__ import annotations

from emulator.cleaning.pipeline import cleaned
from emulator.cleaning.report import KINDS, Cleaned, Repair, verdict_of
from emulator.cleaning.settings import POLICIES, CleaningSettings, settings_of

__all__ = ["KINDS", "POLICIES", "Cleaned", "CleaningSettings", "Repair", "cleaned", "settings_of", "verdict_of"]

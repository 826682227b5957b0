"""Defects: what work leaves wrong, what inspections find, scrap and rework."""

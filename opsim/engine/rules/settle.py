"""The order in which the reports of one instant are applied."""

COMPLETION, REPAIR, BREAKDOWN, CALENDAR, ARRIVAL = range(5)

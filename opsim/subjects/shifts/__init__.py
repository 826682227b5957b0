"""When people and stations are there: shifts, breaks, absence, overtime; and work that is broken off."""

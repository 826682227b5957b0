"""Plan -> EventLog. SimPy is the reference and the default engine."""

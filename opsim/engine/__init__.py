"""Plan -> EventLog. The rules are said once, in ``floor``: SimPy drives them, ``fast_engine`` compiles them."""

ENGINES = ("simpy", "fast", "auto")
SIMPY, FAST, AUTO = ENGINES

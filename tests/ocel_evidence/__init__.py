"""Our OCEL 2.0 files read by somebody else's program: ``make ocel-evidence``."""

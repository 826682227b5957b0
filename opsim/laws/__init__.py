"""What must be true of every event log, checked after every run."""

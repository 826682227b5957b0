"""Studies on a cluster whose workers and client are killed: the same bytes as on one process."""

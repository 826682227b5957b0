"""What long runs say of the steady state. Plain functions on arrays, for any model: no scenario is needed."""

from opsim.study.long_run.batching import BatchMeans, batch_means, correlogram, lag_one, von_neumann
from opsim.study.long_run.diagnostics import Flag, flags
from opsim.study.long_run.warm_up import welch

__all__ = ["BatchMeans", "Flag", "batch_means", "correlogram", "flags", "lag_one", "von_neumann", "welch"]

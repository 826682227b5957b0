"""What long runs say of the steady state. Plain functions on arrays, for any model: no scenario is needed."""

from opsim.study.long_run.batches import BatchMeans, batch_means
from opsim.study.long_run.correlation import correlogram, lag_one, von_neumann
from opsim.study.long_run.flags import Flag, flags
from opsim.study.long_run.welch_curve import welch

__all__ = ["BatchMeans", "Flag", "batch_means", "correlogram", "flags", "lag_one", "von_neumann", "welch"]

"""Studies: many replications of one scenario, with intervals."""

from opsim.study.intervals import Interval, Precision, QuantileInterval, quantile_interval, t_interval
from opsim.study.run import run_scenario

__all__ = ["Interval", "Precision", "QuantileInterval", "quantile_interval", "run_scenario", "t_interval"]

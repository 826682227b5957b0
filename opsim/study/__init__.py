"""Studies: many replications of one scenario, with intervals."""

from opsim.study.interval import Interval, QuantileInterval, quantile_interval, t_interval
from opsim.study.precision import Precision
from opsim.study.run import run_scenario

__all__ = ["Interval", "Precision", "QuantileInterval", "quantile_interval", "run_scenario", "t_interval"]

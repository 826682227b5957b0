"""Studies: many replications of one scenario, with intervals."""

from opsim.study.interval import Interval, t_interval
from opsim.study.run import run_scenario

__all__ = ["Interval", "run_scenario", "t_interval"]

"""What differences between people cost: luck of staffing, a budget of variability, what buys it back, how days end."""

from opsim.study.labour.daily_output import Chance, chance
from opsim.study.labour.variance_components import VariancePart, VarianceParts, mean_interval, variance_parts

__all__ = ["Chance", "VariancePart", "VarianceParts", "chance", "mean_interval", "variance_parts"]

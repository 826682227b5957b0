"""What differences between people cost: luck of staffing, a budget of variability, what buys it back, how days end."""

from opsim.study.labour.day import Chance, chance
from opsim.study.labour.parts import VariancePart, VarianceParts, variance_parts
from opsim.study.labour.squares import mean_interval

__all__ = ["Chance", "VariancePart", "VarianceParts", "chance", "mean_interval", "variance_parts"]

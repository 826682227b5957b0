"""Many points of some factors: where to look, what a factor does, and a response fitted to what was found."""

from opsim.study.sweep.designs import grid, latin_hypercube, morris, one_at_a_time, saltelli, sobol
from opsim.study.sweep.effects import main_effects, tornado
from opsim.study.sweep.response import fit_response
from opsim.study.sweep.sensitivity import morris_effects, sobol_indices

__all__ = [
    "fit_response",
    "grid",
    "latin_hypercube",
    "main_effects",
    "morris",
    "morris_effects",
    "one_at_a_time",
    "saltelli",
    "sobol",
    "sobol_indices",
    "tornado",
]

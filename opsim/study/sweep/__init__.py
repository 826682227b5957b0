"""Many points of some factors: where to look, what a factor does, and a response fitted to what was found."""

from opsim.study.sweep.designs import (
    grid,
    latin_hypercube,
    morris,
    morris_effects,
    one_at_a_time,
    saltelli,
    sobol,
    sobol_indices,
)
from opsim.study.sweep.effects import main_effects, tornado
from opsim.study.sweep.response_surface import fit_response

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

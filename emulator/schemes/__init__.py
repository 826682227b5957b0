"""The schemes of Chen, Park & Srivastava by name, on aligned sequences of postures. A table of contents."""

from emulator.schemes.flattening import ISTVF, MTVF, SIEM, STVF
from emulator.schemes.reductions import MPCA, parallel_analysis
from emulator.schemes.scheme import SCHEMES, DimensionSearch, Scheme, search_dimensions
from emulator.schemes.scheme_choice import choose_scheme

__all__ = [
    "ISTVF",
    "MPCA",
    "MTVF",
    "SCHEMES",
    "SIEM",
    "STVF",
    "DimensionSearch",
    "Scheme",
    "choose_scheme",
    "parallel_analysis",
    "search_dimensions",
]

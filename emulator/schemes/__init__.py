"""The schemes of Chen, Park & Srivastava by name, on aligned sequences of postures. A table of contents."""

from emulator.schemes.choosing import choose_scheme
from emulator.schemes.dimensions import DimensionSearch, search_dimensions
from emulator.schemes.mpca import MPCA
from emulator.schemes.names import SCHEMES
from emulator.schemes.parallel import parallel_analysis
from emulator.schemes.scheme import Scheme
from emulator.schemes.siem import SIEM
from emulator.schemes.velocity import ISTVF, MTVF, STVF

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

"""The tables of numpy's ziggurats, as numba keeps them for its own copy of numpy's generators.

Source: Marsaglia & Tsang (2000), doi:10.18637/jss.v005.i08; numpy/random/src/distributions/ziggurat_constants.h.
"""

from __future__ import annotations

from typing import Any, NamedTuple


class Ziggurat(NamedTuple):
    """256 layers; the names are numpy's.

    k    : (256,) uint64, below which a whole number lies within a layer for certain
    w    : (256,) width of a layer over the range of that number
    f    : (256,) density at the edge of a layer
    """

    k: Any
    w: Any
    f: Any


def exponential() -> Ziggurat:
    """Of the standard exponential. Raises ImportError or AttributeError where numba keeps no such tables."""
    from numba.np.random import _constants as numpys

    return Ziggurat(numpys.ke_double, numpys.we_double, numpys.fe_double)


def normal() -> Ziggurat:
    """Of the standard normal. Raises as ``exponential``."""
    from numba.np.random import _constants as numpys

    return Ziggurat(numpys.ki_double, numpys.wi_double, numpys.fi_double)

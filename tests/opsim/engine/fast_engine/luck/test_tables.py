"""What numba keeps are tables of these ziggurats: held against the densities."""

import numpy as np
import pytest

from opsim.engine.fast_engine.streams import generators


@pytest.mark.parametrize(
    ("table", "density", "bits"),
    [
        (generators.exponential(), lambda x: np.exp(-x), 53),
        (generators.normal(), lambda x: np.exp(-(x**2) / 2), 52),
    ],
    ids=["exponential", "normal"],
)
def test_widths_densities_and_bounds_go_together(table, density, bits):
    edges = table.w * 2.0**bits
    assert np.allclose(table.f[1:], density(edges[1:]), rtol=1e-12) and table.f[0] == 1.0
    inner = edges[1:-1] / edges[2:]
    assert np.allclose(table.k[2:] / 2.0**bits, inner, rtol=1e-12) and table.k[1] == 0

"""What jobs are split into."""

from __future__ import annotations

from opsim.engine.floor.machine import Array, struct


@struct
class Split:
    """n : products of pieces; products, pieces : of each, how many a unit becomes

    n_ways : sources of pieces: of jobs of the source ``of``, those of the product ``made`` come from ``source``, at
    most ``most`` of them a job
    """

    n: int
    products: Array[int]
    pieces: Array[int]
    n_ways: int
    of: Array[int]
    made: Array[int]
    source: Array[int]
    most: Array[int]


@struct
class Splits:
    """Of a station. of : (P,) what becomes of each product there, or nothing."""

    of: Array[Split]

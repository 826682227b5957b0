"""Stores, what lies in them, and who waits for it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from opsim.engine.floor.machine import Array, List, struct

if TYPE_CHECKING:
    from opsim.engine.floor.parts.records import Claim, Source
from opsim.engine.floor.parts.state import Job, Station


@struct
class Shelf:
    """What lies in stores of one product. jobs : in the order in which they came; units : of lots, what is left."""

    jobs: List[Job]
    units: int


@struct
class Stock:
    """shelves : (P,); changed : whether something came since parts were given out."""

    shelves: Array[Shelf]
    changed: int


@struct
class Filling:
    """Jobs of a product that lie in a store at the start. step : of the route of the product, which is the store."""

    station: Station
    source: Source
    product: int
    n_jobs: int
    step: int


@struct
class Need:
    """n : of how many products a unit takes parts at a station, by rank; pieces : of each."""

    n: int
    products: Array[int]
    pieces: Array[int]


@struct
class Kits:
    """stations : where parts go in; needs : by station x products + product; claims : of jobs that wait for parts

    wanted : (P,) pieces that one of them waits for; waiting : those that are looked at in a round
    """

    n_stations: int
    stations: Array[Station]
    needs: Array[Need]
    claims: List[Claim]
    changed: int
    wanted: Array[int]
    waiting: List[Job]


@struct
class Refill:
    """Stores that are kept filled. n_jobs : (P,) jobs of each product on the floor, in stores too."""

    n_sources: int
    sources: Array[Source]
    n_jobs: Array[int]

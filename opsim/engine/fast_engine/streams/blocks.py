"""Streams of one replication that give many blocks at once: what ``Items.block`` of ``draws.py`` gives, as arrays.

Streams of a kind, whose numbers are each made of a few random numbers, are drawn together; a task model's in one call
where every number is made of those of its own place alone, else block by block. Another numpy may draw in another way,
another C library may round a logarithm in another way, and another compiler may fuse a product with a sum: so a process
looks once whether compiled numbers are numpy's, and else numpy draws block by block, and only the time differs.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from numba import config

from opsim.engine.fast_engine.streams.generators import ManyBlocks
from opsim.streams import BLOCK, _generator, _hashed, _key
from opsim.subjects.tools.plan import HoldPlan, Moment
from opsim.task_model import seconds_of

_LOOKED_AT = (*range(10), 1500, 99_999)
_NAME = ("trust",)
_DRAWN: tuple[tuple[int, str, tuple[float, ...]], ...] = (
    (1000, "standard_exponential", ()),
    (1000, "standard_normal", ()),
    (300, "standard_gamma", (1.7,)),
    (50, "uniform", (2.1, 5.3)),
    (50, "triangular", (1.1, 2.3, 7.9)),
)
"""(blocks, method, what it is given). NOTE: of a thousand blocks some ten normals lie beyond the last layer of the
ziggurat, where a logarithm is taken."""


def blocks_of(words: np.ndarray, first: int, n: int) -> ManyBlocks:
    """The generators of n blocks of the stream of a key; numpy's own where what is compiled is not to be trusted."""
    return ManyBlocks(words, first, n, None if is_trusted() else numpys_generators(words, first, n))


def numpys_generators(words: np.ndarray, first: int, n: int) -> list[np.random.Generator]:
    """The generators of n blocks as ``opsim.streams`` makes them."""
    key = words.tobytes()
    return [_generator(key + _hashed(block)) for block in range(first, first + n)]


@cache
def is_trusted() -> bool:
    """Whether what is compiled gives numpy's numbers, and numpy finishes long arrays as it finishes short ones."""
    if getattr(config, "DISABLE_JIT", 0):  # Python's numbers do not end at 64 bits
        return False
    try:
        return _seeds_agree() and all(_agrees(*one) for one in _DRAWN) and _finished_alike()
    except (ImportError, AttributeError):  # numba keeps its tables elsewhere
        return False


def _seeds_agree() -> bool:
    """Keys of several lengths, against numpy's own way from a seed."""
    return all(
        np.array_equal(ManyBlocks(words, block, 1).random(BLOCK), numpys_generators(words, block, 1)[0].random(BLOCK))
        for words in (_words(0, 0), _words(2**32 - 1, 2**40), _words(2**200, 7))
        for block in _LOOKED_AT
    )


def _agrees(n: int, name: str, said: tuple[float, ...]) -> bool:
    """One stream of n blocks against numpy's generators in the same states."""
    ours = getattr(_many(n), name)(*said, n * BLOCK)
    theirs = [getattr(one, name)(*said, BLOCK) for one in _many(n).generators]
    return np.array_equal(ours, np.concatenate(theirs))


def _finished_alike() -> bool:
    """Exponentials in numpy take many numbers at once: the last of an array must not come out otherwise, nor one."""
    x = _many(9).standard_normal(9 * BLOCK)
    whole = np.exp(x)
    by_block = np.concatenate([np.exp(one) for one in x.reshape(9, BLOCK)])
    return np.array_equal(whole, by_block) and np.array_equal(whole, [np.exp(one) for one in x.tolist()])


def _many(n: int) -> ManyBlocks:
    return ManyBlocks(_words(1, 0), 0, n)


def _words(seed: int, replication: int) -> np.ndarray:
    return np.frombuffer(_key(seed, replication, _NAME), np.uint32)


Drawn = Callable[[np.ndarray, int, int], np.ndarray]
"""(key words, first block, number of blocks) -> (n_blocks * 64,) seconds, shares or ranks."""


@dataclass(frozen=True, eq=False, slots=True)
class OfAKind:
    """A ``Drawn`` whose streams can be drawn together with others of the same kind.

    kind    : equal for streams that one ``draw`` can give, hashable
    draw    : (n, generator, *numbers) -> (n,); numbers, or arrays of (n,) where streams differ
    numbers : by which a stream differs from others of its kind
    """

    kind: Any
    draw: Callable[..., np.ndarray]
    numbers: tuple[float, ...] = ()

    def __call__(self, words: np.ndarray, first: int, n: int) -> np.ndarray:
        return self.draw(n * BLOCK, blocks_of(words, first, n), *self.numbers)


@dataclass(frozen=True, eq=False, slots=True)
class NoLuck:
    """A ``Drawn`` that asks no luck: the same in every replication."""

    drawn: Drawn

    def __call__(self, words: np.ndarray, first: int, n: int) -> np.ndarray:
        return self.drawn(words, first, n)


@dataclass(frozen=True, eq=False, slots=True)
class HeldAtShares:
    """How performances are drawn in which a tool is held from one share of each to another."""

    drawn: Drawn
    start: float
    end: float

    def __call__(self, words: np.ndarray, first: int, n: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        return self.drawn(words, first, n), np.full(n * BLOCK, self.start), np.full(n * BLOCK, self.end)


def of_model(model: Any, effect: Any) -> Drawn:
    """Times of a model of this package that makes each of the luck of its own place, for a worker of this effect."""
    from opsim.subjects.tasks.distributions import Fixed
    from opsim.subjects.tasks.model import ByNumbers, SharedTime

    if isinstance(model, Fixed):
        return NoLuck(OfAKind(id(model), lambda n, rng: model.sample(n, rng).duration_s))
    if isinstance(model, ByNumbers):
        return OfAKind(type(model), type(model).sample_side_by_side_s, model.numbers(effect))
    if isinstance(model, SharedTime) and isinstance(effect, float):
        return OfAKind(id(model), lambda n, rng, own: model.sample(n, rng, worker=own).duration_s, (effect,))
    return OfAKind((id(model), id(effect)), lambda n, rng: model.sample(n, rng, worker=effect).duration_s)


Held = tuple[np.ndarray, np.ndarray, np.ndarray]
"""Seconds of each performance, and the shares of it from which to which a tool is held."""
DrawnHeld = Callable[[np.ndarray, int, int], Held]


def durations(model: Any, effect: Any) -> Drawn:
    """How blocks of durations are drawn from a task model, for a worker of this effect."""
    at = getattr(model, "at", None) if getattr(model, "by_index", False) else None
    if at is not None:
        return _trace(seconds_of(model, model.times_s)) if type(model) in _singly() else _by_index(model)
    if in_one_call(model):
        return of_model(model, effect)
    return lambda words, first, n: np.concatenate(
        [seconds_of(model, drawn.duration_s) for drawn in _each(model, effect, words, first, n)]
    )


def held(hold: HoldPlan, model: Any, effect: Any) -> DrawnHeld:
    """How blocks of durations with two moments of each are drawn: from the same numbers."""
    if getattr(model, "by_index", False) or in_one_call(model):
        return _held_at_shares(hold, durations(model, effect), by_index=getattr(model, "by_index", False))

    def draw(words: np.ndarray, first: int, n: int) -> Held:
        columns = zip(*(_of_block(model, drawn, hold) for drawn in _each(model, effect, words, first, n)))
        duration_s, start, end = (np.concatenate(column) for column in columns)
        return duration_s, start, end

    return draw


def in_one_call(model: Any) -> bool:
    """Whether a model's ``sample`` treats each number alone, so that blocks can be drawn together.

    NOTE: exact types only: a child may do anything. A switch is looked through: what it adds is a product.
    """
    return type(_within(model)) in _singly() and is_trusted()


def is_ours(model: Any) -> bool:
    """Whether a model is of this package: it draws from its generator and nothing else, and changes no effect."""
    return type(_within(model)).__module__.startswith(("opsim.subjects.tasks.", "emulator."))


def _within(model: Any) -> Any:
    """The model inside a switch of variability."""
    return model.__dict__["_model"] if type(model) in _switches() else model


def _trace(times_s: np.ndarray) -> Drawn:
    """As ``opsim.tasks.Recorded.at``, of an array that is made once."""
    return NoLuck(lambda _words, first, n: times_s[np.arange(first * BLOCK, (first + n) * BLOCK) % len(times_s)])


def _by_index(model: Any) -> Drawn:
    """A model's own trace, asked block by block."""
    return lambda _words, first, n: np.concatenate(
        [seconds_of(model, model.at(_items(block))) for block in range(first, first + n)]
    )


def _held_at_shares(hold: HoldPlan, drawn: Drawn, *, by_index: bool) -> DrawnHeld:
    """A time without a body has no marks: both moments are shares."""
    start, end = hold.start.share, hold.end.share
    return HeldAtShares(drawn, start, end if by_index else max(start, end))


def _of_block(model: Any, drawn: Any, hold: HoldPlan) -> Held:
    start = _shares(drawn, hold.start)
    return seconds_of(model, drawn.duration_s), start, np.maximum(start, _shares(drawn, hold.end))


def _shares(drawn: Any, moment: Moment) -> np.ndarray:
    """(BLOCK,) where a moment lies in each performance, as a share of its duration."""
    if moment.mark < 0:
        return np.full(BLOCK, moment.share)
    return np.clip(np.asarray(drawn.mark_s)[:, moment.mark] / drawn.duration_s, 0.0, 1.0)


def _each(model: Any, effect: Any, words: np.ndarray, first: int, n: int) -> list[Any]:
    """The performances of each block. A plug-in is given what it is given elsewhere, with all that hangs on it."""
    generators = blocks_of(words, first, n).generators if is_ours(model) else numpys_generators(words, first, n)
    return [model.sample(BLOCK, rng, worker=effect) for rng in generators]


def _items(block: int) -> np.ndarray:
    return np.arange(block * BLOCK, (block + 1) * BLOCK)


@cache
def _singly() -> frozenset[type]:
    from opsim import tasks
    from opsim.subjects.tasks.model import UniformCount

    simple = (tasks.Fixed, tasks.Exponential, tasks.Geometric, tasks.Erlang, tasks.Uniform, tasks.Triangular)
    shared = (tasks.Lognormal, tasks.Gamma, tasks.Weibull, tasks.Hyperexponential, tasks.Normal, tasks.Beta)
    return frozenset((*simple, *shared, tasks.Empirical, tasks.Recorded, UniformCount))


@cache
def _switches() -> frozenset[type]:
    from opsim.subjects.tasks.variability import BetweenOnly, NoSpread, Shuffled, WithinOnly

    return frozenset((WithinOnly, BetweenOnly, NoSpread, Shuffled))


class Stream:
    """Numbers of one name: items ``first * 64`` to ``(first + n) * 64 - 1`` are its blocks ``first`` and after."""

    __slots__ = ("drawn", "words")

    def __init__(self, key: bytes, drawn: Drawn):
        self.words, self.drawn = np.frombuffer(key, np.uint32), drawn

    def fill(self, first: int, n: int) -> np.ndarray:
        """(n * 64,) the numbers of n blocks: seconds or shares in float64, ranks in int64. Any order, any thread."""
        return self.drawn(self.words, first, n)


class HeldStream:
    """As ``Stream``, of performances in which a tool is held."""

    __slots__ = ("drawn", "words")

    def __init__(self, key: bytes, drawn: DrawnHeld):
        self.words, self.drawn = np.frombuffer(key, np.uint32), drawn

    def fill(self, first: int, n: int) -> Held:
        """Three of (n * 64,) float64: seconds, and the shares of them from which to which the tool is held."""
        return self.drawn(self.words, first, n)


uniforms = OfAKind("uniform", lambda n, rng: rng.random(n))
"""In [0, 1)."""


def exponentials(mean_s: float) -> Drawn:
    """The gaps of a Poisson process."""
    return OfAKind("exponential", lambda n, rng, mean_s: rng.exponential(mean_s, n), (mean_s,))


def drawn_ranks(ranks: Sequence[int], cumulative: Sequence[float]) -> Drawn:
    """Rank i of ``ranks`` with probability cumulative[i] - cumulative[i - 1]."""
    found, bounds = np.array(ranks, np.int64), np.array(cumulative)
    kind = "rank", *ranks, *cumulative
    return OfAKind(kind, lambda n, rng: found[_passed(bounds, rng.random(n))])


FEW = 100
"""Bounds that are counted one by one, which takes half as long as a search for every number."""


def _passed(bounds: np.ndarray, u: np.ndarray) -> np.ndarray:
    """(n,) how many of the increasing ``bounds`` (B,) do not lie above u (n,)."""
    if len(bounds) > FEW:
        return np.searchsorted(bounds, u, side="right")
    passed = np.zeros(len(u), np.int8)
    for bound in bounds:
        passed += (u >= bound).view(np.int8)
    return passed.astype(np.intp)


def ranks_by_number(rank_of: Callable[[np.ndarray], np.ndarray]) -> Drawn:
    """Ranks that no luck decides: ``rank_of`` (k,) job numbers -> (k,) int64."""
    return NoLuck(lambda _words, first, n: rank_of(np.arange(first * BLOCK, (first + n) * BLOCK)))

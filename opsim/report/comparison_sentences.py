"""The cells of one difference, each number as exact as its interval.

A comparison said as an engineer would: which variants are better or worse, by how much, and what is not clear.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

from opsim.kpi.catalogue import LESS, MORE, better_of
from opsim.kpi.parts import part_name
from opsim.report.numbers import difference_unit, digits, half_digits, is_number, kpi_name, listing, scale_of

if TYPE_CHECKING:
    from opsim.study.compare import Comparison, Difference


def comparison_cells(
    difference: Difference, largest: float | None = None, beside: Sequence[Difference] = ()
) -> dict[str, str]:
    """The cells of one difference: base, variant, difference ± half-width, per cent of the base, pairing, verdict.

    largest : the mean that chooses the unit; beside : the differences of this figure in all variants, of which the most
    exact says how exactly the base is shown: the same in all rows. A share differs by points, and by no per cent.
    """
    interval, unit = difference.interval, difference.key[3]
    factor, word = scale_of(unit, difference.base if largest is None else largest)
    half = interval.half_width * factor if is_number(interval.half_width) and interval.half_width else None
    of = difference.base * factor if is_number(difference.base) else 0.0
    by = digits(interval.mean * factor, half, of)
    relative = 100 * interval.mean / abs(difference.base) if difference.base else None
    share = None if relative is None or half is None else 100 * interval.half_width / abs(difference.base)
    ratio, points = difference.variance_ratio, difference_unit(word)
    halves = [d.interval.half_width for d in beside or (difference,)]
    finest = min((half * factor for half in halves if is_number(half) and half), default=None)
    by = by if half is None else f"{by} ± {half_digits(interval.mean * factor, half, of)}"
    percent = f"{digits(relative, share, 100.0)} %" if is_number(relative) and points == word else ""
    return {
        "base": quantity_in(difference.base, factor, finest),
        "mean": quantity_in(difference.mean, factor, half),
        "difference": "0" if difference.identical else by,
        "unit": points,
        "relative": "0 %" if percent and difference.identical else percent,
        "pairing": f"{ratio:.3g}" if is_number(ratio) else "",
        "verdict": difference.verdict,
        "n": str(interval.n),
    }


def quantity_in(value: float, factor: float, half_width: float | None) -> str:
    """A mean in a unit chosen before, as exact as the difference is."""
    return digits(value * factor, half_width)


def largest_of(differences: Sequence[Any]) -> float | None:
    """The largest mean of some differences, which chooses their common unit."""
    values = [abs(v) for d in differences for v in (d.base, d.mean) if is_number(v)]
    return max(values, default=None)


MOST_NAMED = 3
"""Figures named of each kind in a sentence; how many others there are is said."""
MANY = 6
"""Variants beyond which they are counted, and the best of them named."""
BEST = 10
CLEAR = ("higher", "lower")
NOT_PROVEN = "not proven"
TOLD = (*CLEAR, NOT_PROVEN)
OUTPUT = ("throughput_per_h", "throughput_per_calendar_h")
MUCH = 0.05
"""A fall of the output that no sentence puts behind what is better, whether it is clear or not."""
SPOKEN = {"duty_use": "busy share of the time on duty", "time_in_system_quantile_s": "time in system (quantile)"}
VERDICTS = {
    "no clear difference": "No clear difference in ",
    "identical": "The same in every replication: ",
    "too few replications to say": "Too few replications, which all differ by as much, to say anything of ",
    "one replication says nothing": "One replication says nothing of ",
    "other hours": "Open for other hours, so nothing is said of ",
}
"""How what is not clear begins; the others are said as they are."""
NO_GOAL = ("posture_measured_share", "walking_measured_share")
"""Figures that say how much is known, not how well the floor does: no sentence speaks of them."""


def answer(comparison: Comparison) -> list[str]:
    """Sentences, the most important first. comparison : of ``opsim.study.compare``"""
    spoken = spoken_of(comparison)
    variants = list(dict.fromkeys(d.variant for d in spoken))
    if len(variants) > MANY:
        return list(_counted(comparison, spoken, variants))
    by_variant = {name: [d for d in spoken if d.variant == name] for name in variants}
    clear = [name for name, of in by_variant.items() if any(d.verdict in TOLD for d in of)]
    hours = bool(comparison.hours)
    said = [_variant(name, by_variant[name], spoken, hours, comparison.tests) for name in clear]
    return [*said, *_unclear({name: by_variant[name] for name in variants if name not in clear}, comparison, spoken)]


def spoken_of(comparison: Comparison) -> list[Any]:
    """The differences of which sentences speak: figures of the whole floor; all, where others alone were asked for."""
    aims = [d for d in comparison.differences if d.key[0] not in NO_GOAL]
    whole = [d for d in aims if not d.key[1] and not d.key[2]]
    return whole or aims or list(comparison.differences)


def spoken_name(difference: Difference, hours: bool = False) -> str:
    """A figure inside a sentence: ``throughput per calendar hour``, ``RULA 5 or more of ana``."""
    kpi, subject, part, _ = difference.key
    name = SPOKEN.get(kpi) or re.sub(r" \([^)]*\)", "", kpi_name(kpi)).split(",")[0]
    name = name[:1].lower() + name[1:] if name[1:2].islower() else name
    if hours and kpi == "throughput_per_h":
        name += " per scheduled hour"
    return " ".join(filter(None, (name, f"of {subject}" if subject else "", part_name(kpi, part))))


def amount(difference: Difference, spoken: Sequence[Any]) -> str:
    """``+13 ± 4 per hour, +2.9 %``; spoken : all that choose the common unit of this figure."""
    cells = comparison_cells(difference, largest_of([d for d in spoken if d.key[0] == difference.key[0]]))
    by = f"{signed(cells['difference'])} {cells['unit']}".strip()
    return f"{by}, {signed(cells['relative'])}" if cells["relative"] else by


def signed(text: str) -> str:
    """A difference with its sign in front, also where it is positive; nothing has none."""
    number = text.partition(" ")[0]
    return text if number.startswith("\N{MINUS SIGN}") or not re.search("[1-9]", number) else f"+{text}"


def way_of(difference: Difference) -> int:
    """1 where the variant is better, -1 where it is worse, 0 where nobody agrees which way is better."""
    better = better_of(difference.key[0], difference.key[2])
    rises = 1 if difference.interval.mean > 0 else -1
    return rises if better == MORE else -rises if better == LESS else 0


def _variant(name: str, of: Sequence[Any], spoken: Sequence[Any], hours: bool, tests: int) -> str:
    """One variant with something clear, or clear by itself alone; what may be worse comes before what is better.

    tests : comparisons that are held together
    """
    clear, alone = ([d for d in of if d.verdict in some] for some in (CLEAR, (NOT_PROVEN,)))
    rest = [d for d in of if d.verdict not in TOLD]
    fallen = [d for d in rest if _falls_much(d)]
    not_proven = f", but that is not proven with {tests} comparisons held together."
    said = [f" is {_ways(clear, spoken, hours)}."] if clear else []
    if alone:
        first = any(way_of(d) == -1 for d in alone) and not any(map(_falls_much, clear))
        said.insert(0 if first else len(said), f" looks {_ways(alone, spoken, hours)}{not_proven}")
    if fallen:
        said.insert(0, f": {_small(_rest(fallen, spoken, hours))}")
    left = [d for d in rest if d not in fallen]
    told = [("It" if at else name) + text for at, text in enumerate(said)]
    return " ".join([*told, _rest(left, spoken, hours)] if left else told)


def _ways(some: Sequence[Any], spoken: Sequence[Any], hours: bool) -> str:
    """``better in a and b, worse in c``; what is worse first where the output falls much."""
    gains, costs, others = ([d for d in some if way_of(d) == way] for way in (1, -1, 0))
    ways = [("better", gains), ("worse", costs), ("other", others)]
    if any(map(_falls_much, costs)):
        ways[:2] = ways[1::-1]
    return ", ".join(f"{word} in {_named(of, spoken, hours)}" for word, of in ways if of)


def _falls_much(difference: Difference) -> bool:
    """Whether it is an output that is less by its mean, proven or not, so much that nothing better outweighs it."""
    whole = difference.key[0] in OUTPUT and not difference.key[1] and difference.verdict != "other hours"
    return bool(whole and difference.interval.mean < -MUCH * abs(difference.base))


def _small(text: str) -> str:
    return text[:1].lower() + text[1:]


def _rest(rest: Sequence[Any], spoken: Sequence[Any], hours: bool) -> str:
    """What is not clear, by what is said of it."""
    said = []
    for verdict in dict.fromkeys(d.verdict for d in rest):
        some = [d for d in rest if d.verdict == verdict]
        with_amounts = verdict == "no clear difference"
        named = _named(some, spoken, hours) if with_amounts else _listed([spoken_name(d, hours) for d in some])
        said.append(f"{VERDICTS.get(verdict, f'{verdict[:1].upper()}{verdict[1:]}: ')}{named}.")
    return " ".join(said)


def _unclear(by_variant: dict[str, Sequence[Any]], comparison: Comparison, spoken: Sequence[Any]) -> Iterator[str]:
    """Variants of which nothing is clear, those with nothing but identical figures together."""
    same = [name for name, of in by_variant.items() if all(d.verdict == "identical" for d in of)]
    for name, of in by_variant.items():
        if name not in same:
            rest = _rest(of, spoken, bool(comparison.hours))
            yield f"{name}: {_small(rest)}"
    if same:
        verb = "is" if len(same) == 1 else "are"
        yield f"{listing(same)} {verb} identical to {comparison.base} in every replication."


def _counted(comparison: Comparison, spoken: Sequence[Any], variants: Sequence[str]) -> Iterator[str]:
    """Many variants: how many are better and worse in the first figures, and the best."""
    hours = bool(comparison.hours)
    for key in list(dict.fromkeys(d.key for d in spoken))[:MOST_NAMED]:
        of = [d for d in spoken if d.key == key]
        clear = [d for d in of if d.verdict in CLEAR]
        judged = bool(better_of(key[0], key[2]))
        ways = [way_of(d) if judged else (1 if d.verdict == "higher" else -1) for d in clear]
        up, down = ("better", "worse") if judged else ("higher", "lower")
        yield (
            f"In {spoken_name(of[0], hours)} {ways.count(1):,} of {len(variants):,} variants are clearly {up} than "
            f"{comparison.base} and {ways.count(-1):,} clearly {down}; {len(of) - len(clear):,} show nothing clear."
        )
    best = best_of(spoken)
    if best:
        first = best[0]
        verb = "is" if first.verdict in CLEAR else "is by its mean, not clearly,"
        name = spoken_name(first, hours)
        yield f"Best in {name} {verb} {first.variant} ({amount(first, [d for d in spoken if d.key == first.key])})."


def best_of(spoken: Sequence[Any], most: int = BEST) -> list[Any]:
    """The best variants in the first figure of which a way is better (else: the highest), the best first."""
    keys = list(dict.fromkeys(d.key for d in spoken))
    key = next((key for key in keys if better_of(key[0], key[2])), keys[0] if keys else None)
    of = [d for d in spoken if d.key == key and d.interval.mean == d.interval.mean]
    sign = 1 if key is not None and better_of(key[0], key[2]) == LESS else -1
    return sorted(of, key=lambda d: sign * d.interval.mean)[:most]


def _named(some: Sequence[Any], spoken: Sequence[Any], hours: bool) -> str:
    return _listed([f"{spoken_name(d, hours)} ({amount(d, spoken)})" for d in some])


def _listed(words: Sequence[str]) -> str:
    """The first three, and how many others."""
    more = len(words) - MOST_NAMED
    figures = "1 more figure" if more == 1 else f"{more} more figures"
    return listing([*words[:MOST_NAMED], figures] if more > 0 else list(words))

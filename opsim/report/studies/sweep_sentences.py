"""What a sweep found of one figure, in sentences as an engineer would say them.

How good a fitted response is, in sentences.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from opsim.kpi.catalogue import LESS, MORE
from opsim.report.numbers import (
    difference_unit,
    digits,
    half_digits,
    is_number,
    largest_of,
    listing,
    plus_minus,
    scale_of,
)
from opsim.report.sections.pareto import axis_name

LITTLE = 0.1
"""Of the largest effect: a factor hardly matters where it surely does less."""
MOST_NAMED = 4
WIDE = 0.2
"""A half-width of a share of variance with which little can be said."""


def sentences_of(found: Any, points: Any, first: bool = True) -> list[str]:
    """The answer of one figure. found : a Found; points : the Points; first : of the figures, whose says more"""
    said = list(_effects(found)) if found.swings else list(_sensitivity(found, points.design))
    return [text for text in (" ".join(said), *_best(found, points, first)) if text]


def changed(interval: Any, unit: str, largest: float | None, sign: bool = True) -> str:
    """``+12.4 ± 0.8 per hour``: a difference in the unit that suits the figure's size; ``largest`` chooses it."""
    if interval.n and interval.mean == 0 and interval.sd == 0:
        return "0"
    factor, word = scale_of(unit, largest)
    mean = interval.mean * factor
    if not is_number(mean):
        return "no value"
    half = interval.half_width * factor if is_number(interval.half_width) else None
    text = digits(mean, half)
    plus = "+" if sign and mean > 0 and text.strip("0.,") else ""
    behind = f" ± {half_digits(mean, half)}" if half else ""
    return f"{plus}{text}{behind} {word}".strip()


def _effects(found: Any) -> Iterator[str]:
    name, unit, largest = axis_name(found.key), found.key[3], largest_of(found)
    clear = [one for one in found.swings if one.clear]
    others = [one for one in found.swings if not one.clear]
    if found.replications == 1:
        yield f"{name}: one replication of each point says nothing of chance; take more (--replications)."
        return
    if found.how == "fit" and not found.response.trusted:
        yield f"{name}: the fitted response is not to be trusted, so what each factor does is not told; see its points."
        return
    if not clear:
        yield f"{name}: no factor's effect is told from chance in {found.replications} replications."
        return
    top = clear[0]
    little = [one for one in found.swings if _most(one) < LITTLE * top.size]
    told = [one for one in clear if one not in little]
    way = found.best.better if found.best is not None else MORE
    most = "most" if found.swings[0].clear else "clearly"  # what is not told from chance may be larger
    verb = f"goes down {most}" if way == LESS else f"goes up {most}"
    effects = [f"{one.name}: {_rise(one, unit, largest, way)}" for one in told[:MOST_NAMED]]
    rest = f"; {len(told) - MOST_NAMED} more matter less" if len(told) > MOST_NAMED else ""
    yield f"{name} {verb} with {'; then with '.join(effects)}{rest}."
    if little:
        verb = "hardly matters" if len(little) == 1 else "hardly matter"
        yield f"{_names(little)} {verb} for it: less than {LITTLE:.0%} of that."
    unsure = [one for one in others if one not in little]
    if unsure:
        verb = "does" if len(unsure) == 1 else "do"
        yield f"Whether {_names(unsure)} {verb} anything to it is not told from chance."


def _names(swings: Sequence[Any]) -> str:
    names = [one.name for one in swings]
    return listing([*names[:MOST_NAMED], f"{len(names) - MOST_NAMED} more"] if len(names) > MOST_NAMED else names)


def _most(one: Any) -> float:
    """How large the effect may be."""
    half = one.rise.half_width
    return one.size + (half if is_number(half) else float("inf"))


def _rise(one: Any, unit: str, largest: float | None, way: str) -> str:
    """From one level to the other, in the way that is better."""
    names = one.levels[one.least].name, one.levels[one.most].name
    rise = one.rise
    if way == LESS:
        from dataclasses import replace

        names, rise = names[::-1], replace(rise, mean=-rise.mean)
    return f"{changed(rise, unit, largest)} from {names[0]} to {names[1]}"


def _best(found: Any, points: Any, first: bool) -> Iterator[str]:
    if found.best is None:
        return
    best, where = found.best, point_words(points, found.best.row)
    row = {"mean": best.mean.mean, "half_width": best.mean.half_width or None, "unit": found.key[3]}
    extreme = "Highest" if best.better == MORE else "Lowest"
    mean = plus_minus(row, largest_of(found))
    said = f"{extreme} {_inside(axis_name(found.key))} of the {len(found.means)} points: {mean} at {where}"
    if best.shared < found.replications:
        said += f" (values are missing: compared in {best.shared} or more of {found.replications} replications)"
    again = "; 'opsim select' looks again" if first else ""
    picked = f" (picked, so likely flattered{again})" if best.mean.sd else ""  # nan of one replication
    if found.replications == 1:
        yield f"{said}, by one replication{picked}."
    elif best.like_it:
        verb = "is" if best.like_it == 1 else "are"
        others = f"{best.like_it} other point" + ("" if best.like_it == 1 else "s")
        yield f"{said}; {others} {verb} not told from it{picked}."
    else:
        ahead = "the other" if len(found.means) == 2 else "all others"
        yield f"{said}, clearly ahead of {ahead}{picked}."


def _inside(name: str) -> str:
    """A figure's name inside a sentence; RULA stays RULA."""
    return name if name[1:2].isupper() else name[:1].lower() + name[1:]


def point_words(points: Any, row: int) -> str:
    """``release.every 40 s, saw.buffer 4``; what a point leaves alone is not said."""
    pairs = zip(points.factors, points.values[row])
    said = [f"{factor.path} {words}" for factor, value in pairs if (words := factor.words(value)) != "as it is"]
    return ", ".join(said) or "the scenario as it is"


def _sensitivity(found: Any, design: str) -> Iterator[str]:
    name = axis_name(found.key)
    if not found.sensitivity:
        if design in ("sobol_indices", "morris"):
            yield f"{name}: a point has no value, so which factor matters cannot be said."
        return
    ranked = sorted(zip(found.factors, found.sensitivity), key=lambda pair: -pair[1].total)
    if design == "morris":
        factor, word = scale_of(found.key[3], largest_of(found))
        unit = difference_unit(word)
        said = [f"{f.path}: {_about(one.total * factor, one.total_half * factor)} {unit}".strip() for f, one in ranked]
        yield f"{name} moves most with {said[0]} from one end to the other, on average{_then(said[1:])}."
    else:
        said = [f"{f.path}: {_about(100 * one.total, 100 * one.total_half)} %" for f, one in ranked]
        yield (
            f"Of the variance of {_inside(name)} over the ranges, most comes with {said[0]}, alone and with others"
            f"{_then(said[1:])}."
        )
        if max(one.total_half for _, one in ranked) > WIDE:
            yield "These intervals are wide: take more base points (--points)."
    if is_number(found.noise_share) and found.noise_share > 0.05:
        yield (
            f"Luck makes {percent(found.noise_share)} of the differences between the points; it counts as if it were "
            "an effect of every factor: more replications make it less."
        )


def _then(said: Sequence[str]) -> str:
    return f"; then {listing(list(said[:MOST_NAMED]))}" if said else ""


def _about(value: float, half: float) -> str:
    return f"{digits(value, half)} ± {half_digits(value, half)}" if half else digits(value)


def percent(share: float) -> str:
    """A share, which is only all where nothing is missing."""
    return f"{100 * max(share, 0):.0f} %" if share < 0.995 else f"{min(100 * share, 99.9 if share < 1 else 100):.1f} %"


SHAPES = {
    "linear": "straight lines",
    "linear with squares": "parabolas",
    "linear with interactions": "straight lines that depend on each other",
    "quadratic": "parabolas that depend on each other",
}
"""What a fit of each kind can be."""


def fit_sentences(found: Any) -> list[str]:
    """How good the fitted response is, and whether it is to be trusted."""
    response = found.response
    if response is None:
        return [f"No response is fitted: {found.no_response}."] if found.no_response else []
    factor, word = scale_of(found.key[3], largest_of(found))
    miss = f"{_two(response.loo_rmse * factor)} {word}".strip()
    noise = f"; the noise of a point's mean around the fit is {_two(response.noise * factor)} {word}".rstrip()
    return [
        f"Fitted response ({response.kind}, {len(response.terms)} terms, {response.n_points} points): it misses a "
        f"point that it has not seen by {miss} (root mean square, leave one out)"
        + (noise if is_number(response.noise) else "")
        + f". It explains {percent(response.r2_predicted)} of how such points differ.",
        _trust(response),
    ]


def _trust(response: Any) -> str:
    if response.r2_predicted < 0.5:
        return "The fit is not to be trusted: it says hardly more than the mean of all points. Look at the points."
    spare = "1 point" if response.spare == 1 else f"{response.spare} points"
    few = f" Only {spare} more than terms: run more points." if response.spare < 3 else ""
    if not response.trusted:
        why = "it misses the points clearly by more than their noise" if response.bent else "it misses too much"
        return f"Do not trust the fit between the points: {why}. Take more points, or narrower ranges.{few}"
    if response.bent:
        return (
            f"It misses the points by more than their noise (lack of fit, p {_p(response.lack_of_fit_p)}): the shape "
            f"is a little other than {SHAPES[response.kind]}. Read it to that error, no finer.{few}"
        )
    return f"The fit may be read between the points, to that error; not outside of the ranges.{few}"


def _two(size: float) -> str:
    """An error with two digits."""
    return f"{float(f'{size:.2g}'):,g}"


def _p(p: float) -> str:
    return "below 0.001" if p < 0.001 else f"{p:.2g}"

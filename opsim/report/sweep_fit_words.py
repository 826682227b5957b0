"""How good a fitted response is, in sentences."""

from __future__ import annotations

from typing import Any

from opsim.report.sweep_words import largest_of, percent
from opsim.report.words import is_number, scale_of

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

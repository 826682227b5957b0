"""What came of choosing the best, in sentences, as an engineer would say it."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from opsim.kpi.catalogue import MORE
from opsim.report.numbers import digits, half_digits, is_wide, listing, scale_of
from opsim.report.sections.pareto import axis_name

MOST_GROUPS, MOST_NAMES, MOST_LETTERS = 3, 4, 70
PROVEN_WITHIN = ("rinott", "ocba")
"""Procedures whose word holds too where several are closer to the best than the indifference."""


def answer_of(found: Any) -> list[str]:
    """What is to be known first: who is best, by how much, with which promise; or why nobody is chosen."""
    return [*_verdict(found), *_out_sentences(found), *_limit_sentences(found), *_search_sentences(found)]


def named(name: str) -> str:
    """A variant in a sentence."""
    return f"'{name}'"


def chosen_one(found: Any, name: str = "") -> str:
    """The chosen one, or another; and where a search found it, what it is."""
    name = name or found.winner
    called = found.called.get(name, "")
    return f"{named(name)} ({called})" if called else named(name)


def amount(value: float, unit: str, half_width: float | None = None) -> str:
    """``62.1 ± 0.4 per hour``."""
    factor, word = scale_of(unit, value)
    half = half_width * factor if half_width is not None and is_wide(value, half_width) else None
    text = digits(value * factor, half)
    if half is not None:
        text += f" ± {half_digits(value * factor, half)}"
    return f"{text} {word}".strip()


def exact(value: float, unit: str, most_digits: int = 4) -> str:
    """An amount that somebody chose, as round as they wrote it: ``0.5 per hour``."""
    factor, word = scale_of(unit, value)
    return f"{value * factor:.{most_digits}g}{' ' if word not in ('', '%', '°') else ''}{word}".replace("%", " %")


def allowed(limit: Any, unit: str) -> str:
    """``at most 10 min/h``."""
    return f"at {'most' if limit.sense == '<=' else 'least'} {exact(limit.bound, unit, 7)}"


def changed(by: Any, unit: str, base: str, higher: str = "more", lower: str = "less") -> str:
    """``3.2 ± 0.5 per hour more than 'base'``, or that it cannot be told from it."""
    if by.sd == 0 and by.mean == 0:
        return f"the same as {named(base)} in each of them"
    clear = abs(by.mean) > by.half_width
    said = amount(abs(by.mean), unit, by.half_width)
    return f"{said} {higher if by.mean > 0 else lower} than {named(base)}{'' if clear else ' (may be chance)'}"


def _verdict(found: Any) -> Iterator[str]:
    selection = found.selection
    if selection is None:
        yield f"The search left one point, {chosen_one(found)}: nothing was compared, and nothing is promised of it."
        yield from _fresh(found, "It has")
    elif selection.ended == "none within":
        yield from _none_within(found)
    elif selection.ended == "ran out":
        yield from _ran_out(found)
    elif selection.ended == "tied":
        yield _tied(found)
        yield from _fresh(found, f"{named(found.winner)} has")
    else:
        yield from _chosen(found)
    yield from _doubts(found)


def _tied(found: Any) -> str:
    """What happens in 3 / n of replications or more is missed by n of them with a chance below 0.05."""
    selection = found.selection
    many = listing([chosen_one(found, one) for one in selection.tied])
    n = selection.n[selection.systems.index(found.winner)]
    rare = f"they hardly differ in more than {300 / n:.2g} % of replications"
    return f"The best {_among(found)} are {many}, the same in all {n:,} replications: take either ({rare})."


def _chosen(found: Any) -> Iterator[str]:
    selection = found.selection
    best_one = chosen_one(found)
    proven = "" if selection.procedure in PROVEN_WITHIN else "(by experience, not proof) "
    within = f"or {proven}within {exact(found.indifference, found.key[3])} of it"
    [fresh] = _fresh(found, "")
    if selection.posterior is None:
        yield f"{_chance(found)} {best_one} is the best {_among(found)}, {within}: {fresh}"
        return
    best, good = (_probable(one) for one in selection.posterior)
    n = sum(selection.n)
    spent = "" if selection.ended == "chosen" else f"; the {n:,} replications were not enough for {_percent(found)}"
    likely = f"is the best {_among(found)} with a probability of {best}"
    yield f"After {n:,} replications {best_one} {likely}, {within} with {good}{spent}: {fresh}"


def _probable(chance: float) -> str:
    return "more than 99.9 %" if chance > 0.999 else f"at least {100 * chance:.3g} %"


def _chance(found: Any) -> str:
    return f"With at least {_percent(found)} confidence"


def _percent(found: Any) -> str:
    return f"{100 * found.confidence:.4g} %"


def _among(found: Any) -> str:
    of = f"of {len(found.selection.systems)}"
    return f"of those {of} that keep {_limits(found)}" if found.limits else of


def _limits(found: Any) -> str:
    return "the limit" if len(found.limits) == 1 else "the limits"


def _fresh(found: Any, begin: str) -> Iterator[str]:
    fresh, unit = found.fresh, found.key[3]
    if fresh is None:
        return
    mean = fresh.chosen[0]
    said = f"{begin} {amount(mean.mean, unit, mean.half_width)} on {fresh.n} fresh replications".strip()
    if fresh.difference is None:
        yield f"{said}. It is the base: nothing is to be changed."
    else:
        not_so = "" if _base_is_within(found) else f", which does not keep {_limits(found)}"
        yield f"{said}, {changed(fresh.difference, unit, found.base)}{not_so}."


def _none_within(found: Any) -> Iterator[str]:
    """Who is nearest, counted in tolerances of the limit that is broken most."""
    selection = found.selection
    beyond = [
        max(float(limit.over(np.array(mean))) / limit.tolerance for limit, mean in zip(found.limits, of))
        for of in selection.limited
    ]
    i = int(np.argmin(beyond))
    has = [f"{amount(mean, key[3])} of {axis_name(key)}" for key, mean in zip(found.keys, selection.limited[i])]
    asked = [f"{allowed(limit, key[3])}" for limit, key in zip(found.limits, found.keys)]
    yield f"Nobody is chosen: none of {len(selection.systems)} keeps {_limits(found)} ({listing(asked)})."
    yield f"Nearest is {named(selection.systems[i])}, with {listing(has)}."


def _ran_out(found: Any) -> Iterator[str]:
    selection = found.selection
    if selection.needed:
        over = {s: n for s, n in zip(selection.systems, selection.needed) if n > found.most}
        said = listing([f"{named(name)} would need {n:,}" for name, n in list(over.items())[:MOST_NAMES]])
        yield f"Nobody is chosen: {said} replications, at most {found.most:,} are allowed."
    else:
        yield f"Nobody is chosen: {'; '.join(_open(found))}."
    if selection.affordable > found.indifference:
        told = exact(rounded_up(selection.affordable), found.key[3])
        yield f"So many replications tell differences of {told}: say so (--indifference), or allow more (--most)."
    if selection.open_limits:
        yield f"To know who keeps {_limits(found)}, allow more replications (--most), or a wider +- (--subject-to)."


def _open(found: Any) -> Iterator[str]:
    """What is open of those left: who is better, who keeps the limits."""
    selection, after = found.selection, f"after {found.most:,} replications, the most allowed"
    close = _some([name for name in selection.left if any(name in pair for pair in selection.open_pairs)])
    if close:
        yield f"{close} are still too close to tell {after}"
    unknown = list(dict.fromkeys(name for name, _ in selection.open_limits))
    if unknown:
        keep = "keeps" if len(unknown) == 1 else "keep"
        yield f"whether {_some(unknown)} {keep} {_limits(found)} is open{'' if close else f' {after}'}"


def _some(names: Sequence[str]) -> str:
    """The first of them, and how many more there are; "" of none."""
    more = [f"{len(names) - MOST_NAMES} others"] if len(names) > MOST_NAMES else []
    return listing([*map(named, names[:MOST_NAMES]), *more])


def rounded_up(value: float) -> float:
    """To two digits, not below what it was."""
    step = 10.0 ** (math.floor(math.log10(value)) - 1) if value > 0 else 1.0
    return math.ceil(value / step) * step


def _doubts(found: Any) -> Iterator[str]:
    """Where the fresh replications do not bear out what was chosen."""
    fresh = found.fresh
    if fresh is None:
        return
    if _base_is_better(found):
        chosen_among = found.base in found.changes
        why = "unlucky: try another --seed" if chosen_among else "it was not among those to choose from"
        yield f"But on the fresh replications {named(found.base)} is better: {why}."
    for limit, key, of in zip(found.limits, found.keys, fresh.chosen[1:]):
        if limit.over(of.mean) > limit.tolerance:
            yield f"But on the fresh replications it is beyond the limit on {axis_name(key)}."


def _base_is_better(found: Any) -> bool:
    """Clearly, by more than does not matter, and within the limits."""
    by = found.fresh.difference
    if by is None or not _base_is_within(found):
        return False
    ahead = -by.mean if found.better == MORE else by.mean
    return bool(ahead > max(by.half_width, found.indifference))


def _base_is_within(found: Any) -> bool:
    return all(limit.over(of.mean) <= limit.tolerance for limit, of in zip(found.limits, found.fresh.base[1:]))


def _out_sentences(found: Any) -> Iterator[str]:
    """Who was thrown out when: 'a' was out after 12 replications, 'b' and 'c' after 30 (beyond the limit)."""
    groups: dict[tuple[int, str], list[str]] = {}
    thrown = found.selection.out if found.selection is not None and found.selection.ended != "none within" else ()
    for out in thrown:
        groups.setdefault((out.n, out.limit), []).append(named(out.system))
    said: list[str] = []
    for (n, limit), names in list(groups.items())[:MOST_GROUPS]:
        many = listing(names) if len(listing(names)) <= MOST_LETTERS else f"{len(names)} of them"
        middle = "after" if said else f"{'was' if len(names) == 1 else 'were'} out after"
        said.append(f"{many} {middle} {n}{'' if said else ' replications'}{' (beyond the limit)' if limit else ''}")
    if len(groups) > MOST_GROUPS:
        rest = list(groups)[MOST_GROUPS:]
        said.append(f"{sum(len(groups[one]) for one in rest)} more by {rest[-1][0]}")
    if said:
        yield f"{', '.join(said)}."


def _limit_sentences(found: Any) -> Iterator[str]:
    if found.fresh is not None:
        for limit, key, of in zip(found.limits, found.keys, found.fresh.chosen[1:]):
            has = amount(of.mean, key[3], of.half_width)
            yield f"{axis_name(key)}: {has}, {allowed(limit, key[3])} is allowed."


def _search_sentences(found: Any) -> Iterator[str]:
    tried = found.searched
    if tried is None:
        return
    refused = sum(bool(trial.refused) for trial in tried.trials)
    no = f", {refused} could not be run" if refused else ""
    each = f"{tried.replications} replication{'' if tried.replications == 1 else 's'} each"
    n = len(tried.trials)
    yield f"The search tried {n} points on {each}{no}; the best {len(tried.finalists)} went on to be compared."
    if found.winner and found.fresh is not None:
        seen, now = tried.trials[tried.finalists[found.winner]], found.fresh.chosen[0]
        yield f"It saw {_flattered(seen, now, found)}."


def _flattered(seen: Any, now: Any, found: Any) -> str:
    """``42.8 per hour for the chosen one, 0.4 more``; why, where that is more than the errors of both explain."""
    factor, word = scale_of(found.key[3], seen.mean)
    by, half = seen.mean - now.mean, now.half_width * factor
    saw, more = (digits(one * factor, half) for one in (seen.mean, abs(by)))
    way = "more" if by > 0 else "less"
    good = by * (1 if found.better == MORE else -1)
    clear = good > math.hypot(seen.half_width, now.half_width)
    why = ": the best of many looks better than it is" if clear else " (may be chance)"
    return f"{saw} {word} for the chosen one, {more} {way} than the fresh ones{why}".replace("  ", " ")

"""What a layout study says in sentences: what to move, what it saves, how sure that is."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from opsim.report.numbers import digits, half_digits, is_number, kpi_name, listing, scale_of
from opsim.study.layout.evaluate import BEST, EACH, EXPOSURE, EXPOSURE_EACH, SHARE, WALKED, Against
from opsim.study.layout.study import NOW, LayoutFound, gains, moved_stations, said

SHIFT_H = 8.0
NO_DIFFERENCE, NOT_MEASURED = "no clear difference", "not measured"
SAME = 0.02
"""Of the output: a difference that is surely less than this share is told as none."""


def answer(found: LayoutFound) -> list[str]:
    """The most important first."""
    return [*_headline(found), *_by_few(found), *_alike(found), *_caution(found), *_clash(found)]


def walking(one: Against) -> str:
    """``31 ± 1 % less walking``."""
    return f"{_percent(one)} walking" if one.clear else f"{NO_DIFFERENCE} in walking"


def best(found: LayoutFound, one: Against) -> str:
    """``6.1 ± 0.3 more an hour`` for the throughput, else the figure with its name."""
    asked = found.asked.best
    if asked.name == "walked_m":
        return ""
    if asked.kpi == "throughput_per_h":
        return (
            f"{_amount(one)} parts an hour ({_percent(one, plain=True)})"
            if one.clear
            else f"{NO_DIFFERENCE} in throughput"
        )
    factor, unit = scale_of(figure_unit(asked.kpi), one.now.mean)
    name = kpi_name(asked.kpi)
    return f"{name} {_amount(one, factor, unit)}" if one.clear else f"{NO_DIFFERENCE} in {name.lower()}"


def exposure(found: LayoutFound, of: Any) -> str:
    """What becomes of the second criterion, per part too where that says something else."""
    asked, one, each = found.asked.exposure, of.get(EXPOSURE), of.get(EXPOSURE_EACH)
    if asked is None or one is None:
        return ""
    name = exposure_name(found)
    name = name[:1].lower() + name[1:] if name[1:2].islower() else name
    if not one.measured:
        return f"{name}: {NOT_MEASURED}, because {why_not_measured(found)}"
    if not one.clear:
        return f"{name}: {NO_DIFFERENCE}"
    per_part = "" if each is None else f" (per part {_percent(each) if each.clear else NO_DIFFERENCE})"
    return f"{name}: {_percent(one)}{per_part}"


def exposure_name(found: LayoutFound) -> str:
    """The figure in words, and whose it is."""
    asked = found.asked.exposure
    assert asked is not None
    return f"{kpi_name(asked.kpi)}, of {asked.subject or 'the worker who has most of it'}"


def why_not_measured(found: LayoutFound) -> str:
    """Of the second criterion, where no replication has a value of it."""
    from opsim.kpi.catalogue import needs_postures

    asked = found.asked.exposure
    assert asked is not None
    whose = f"{asked.subject} does" if asked.subject else "is done here"
    if needs_postures([asked.kpi]):
        return f"no work that {whose} has a known posture that it could be taken from"
    return "no replication has a value of it"


def _figure(found: LayoutFound) -> str:
    """By what the best is taken, in a sentence."""
    kpi = found.asked.best.kpi
    return "throughput" if kpi == "throughput_per_h" else kpi_name(kpi).lower()


def _headline(found: LayoutFound) -> Iterator[str]:
    taken = found.taken
    if taken is None:
        if not found.candidates:
            yield "No layout of these places is shorter for today's trips: leave it as it is."
            return
        n = len(found.candidates)
        none = "the other layout is not" if n == 1 else f"none of these {n} layouts is"
        yield f"Leave it as it is: simulated, {none} clearly better by {_figure(found)} or as good with less walking."
        return
    of, do = found.fresh, said(found.asked.floor.at, taken)
    bodies = exposure(found, of)
    first = f"{do[0].upper()}{do[1:]}" if taken.proposed else f"{taken.name} ({do})" if do != taken.name else do
    if not found.gains:
        yield "Leave it as it is: on fresh random numbers the best layout found shows no clear gain."
        first = f"That was to {do}" if taken.proposed else f"That was {first}"
    yield f"{first}: {_changes(found)}{'; ' if bodies else ''}{bodies}."
    each, share = of[EACH], of[SHARE]
    yield (
        f"That is {digits(each.then.mean, each.difference.half_width)} m walked a part in place of "
        f"{digits(each.now.mean, each.difference.half_width)} m, and people walk "
        f"{100 * share.then.mean:.0f} % of their time in place of {100 * share.now.mean:.0f} %."
    )
    yield (
        f"Measured in {found.asked.replications} fresh replications that had no part in choosing it, beside the "
        "present layout on the same random numbers (± is 95 %)."
    )


def _changes(found: LayoutFound) -> str:
    """Walking and output; where one is better and the other worse, the good one first and a ``but`` between them."""
    of = found.fresh
    told = {WALKED: walking(of[WALKED]) + _saved(of[WALKED]), BEST: best(found, of[BEST])}
    good, bad = found.gains, found.losses
    if good and bad:
        return f"{told[good[0]]}, but {told[bad[0]]}"
    return ", ".join(filter(None, told.values()))


def _saved(one: Against) -> str:
    """The metres of a shift, of all people together."""
    if not one.clear:
        return ""
    metres, half_m = abs(one.difference.mean) * SHIFT_H, one.difference.half_width * SHIFT_H
    factor, unit = scale_of("m", metres)
    text = f"{digits(metres * factor, half_m * factor or 0.01 * metres)} {unit} {_way(one)}"
    return f" ({text} in {SHIFT_H:.0f} hours by all together)"


def _by_few(found: LayoutFound) -> Iterator[str]:
    """What can be had by moving fewer stations than the one taken does."""
    if found.taken is None or not found.gains:
        return
    at = found.asked.floor.at
    of_taken = len(moved_stations(at, found.taken))
    fewer = [one for one in found.candidates if one.proposed and 0 < len(moved_stations(at, one)) < of_taken - 1]
    good = [one for one in fewer if gains(found.compared[one.name], found.asked.best)]
    few = []
    for one in sorted(good, key=lambda one: len(moved_stations(at, one)))[:2]:
        of = found.compared[one.name]
        few.append(f"{said(at, one)}: {', '.join(filter(None, (walking(of[WALKED]), best(found, of[BEST]))))}")
    if few:
        yield f"If less may be moved (from the replications of the choice, not the fresh ones), {'; '.join(few)}."


def _alike(found: LayoutFound) -> Iterator[str]:
    """Those that no test tells from the best."""
    if found.taken is None:
        return
    best, others = _name(found.taken.name), [_name(name) for name in found.alike if name != found.taken.name]
    if others:
        yield (
            f"No test tells {listing(others)} from {best} by {_figure(found)}; of all these {best} has the least "
            "walking."
        )


def _name(layout: str) -> str:
    return "the present layout" if layout == NOW else f"'{layout}'" if " " in layout else layout


def _clash(found: LayoutFound) -> Iterator[str]:
    if found.asked.clash:
        yield f"All changes together are left out, since they clash: {found.asked.clash}."


def _caution(found: LayoutFound) -> Iterator[str]:
    one = found.fresh.get(BEST)
    if one is None or found.asked.best.kpi != "throughput_per_h":
        return
    if found.fresh[WALKED].less and not one.clear and one.within(SAME):
        yield f"What is saved is walking: the output stays the same within {100 * SAME:.0f} %."


def _percent(one: Against, *, plain: bool = False) -> str:
    mean, half = (100 * value for value in one.relative)
    if not is_number(mean):
        return _way(one)
    text = (
        f"{digits(abs(mean), half)} ± {half_digits(mean, half)} %" if is_number(half) and half else f"{abs(mean):.3g} %"
    )
    return text if plain else f"{text} {_way(one)}"


def _amount(one: Against, factor: float = 1.0, unit: str = "") -> str:
    mean, half = one.difference.mean * factor, one.difference.half_width * factor
    text = f"{digits(abs(mean), half, one.now.mean * factor)} ± {half_digits(mean, half, one.now.mean * factor)}"
    return f"{text} {unit}".strip() + f" {_way(one)}"


def _way(one: Against) -> str:
    return "more" if one.difference.mean > 0 else "less"


def figure_unit(kpi: str) -> str:
    """The unit that a figure's name ends in; "" where it says none."""
    return next((unit for ending, unit in _ENDINGS.items() if kpi.endswith(ending)), "")


_ENDINGS = {
    **{"_min_per_h": "min/h", "_per_h": "1/h", "_per_calendar_h": "1/h", "_per_min": "1/min", "_share": "share"},
    **{"_s": "s", "_m": "m", "_deg": "deg", "_h": "h"},
}

"""What ``opsim compare`` is asked for, checked before the runs that take minutes."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

EXAMPLE = "such as throughput_per_h,walked_m"
SECTIONS = {"worker": "workers", "station": "stations", "task": "tasks", "product": "products"}


def check_asked(variants: Mapping[str, Any], base: str, kpis: Sequence[str], frontier: str | None) -> None:
    """variants : as read, none of them run yet; frontier : as ``--frontier`` has it, None: as the scenario has it.

    Raises ValueError with all mistakes, a line each: a base that is not there, names of figures that no run can have.
    """
    from opsim.kpi.names import KPIS
    from opsim.problems import did_you_mean

    wrong = []
    if base not in variants:
        wrong.append(f"no variant {base!r} to compare with; {did_you_mean(base, variants, otherwise='there are')}")
    wrong += [f"no figure {kpi!r}; {did_you_mean(kpi, KPIS)}" for kpi in kpis if kpi not in KPIS]
    made = _made(variants)
    wrong += [_not_made(kpi) for kpi in kpis if kpi in KPIS and _needs(kpi) and kpi not in made]
    texts = frontier_texts(frontier)
    if texts is None:
        first = next(iter(variants.values()))
        texts = list(variants.get(base, first).scenario.frontier or ())
    wrong += [words for text in texts if (words := _wrong(text, variants, made))]
    if len(texts) == 2 and not wrong and _name(texts[0]) == _name(texts[1]):
        wrong.append(f"the frontier needs two different figures, found {_name(texts[0])} twice")
    if wrong:
        raise ValueError("\n".join(dict.fromkeys(wrong)))


def frontier_texts(frontier: str | None) -> list[str] | None:
    """Both figures of ``--frontier``, None where it is not given. Raises ValueError where these are not two."""
    if frontier is None:
        return None
    texts = [text.strip() for text in frontier.split(",")]
    if len(texts) != 2 or not all(texts):
        raise ValueError(f"--frontier: expected two figures and a comma between them, found {frontier!r}; {EXAMPLE}")
    return texts


def _name(text: str) -> str:
    from opsim.kpi.better import read_asked

    return read_asked(text).name


def _made(variants: Mapping[str, Any]) -> set[str]:
    """Figures that some variant asks for."""
    from opsim.kpi.better import read_asked

    scenarios = [loaded.scenario for loaded in variants.values()]
    axes = {read_asked(text).kpi for scenario in scenarios for text in scenario.frontier or ()}
    return axes | {kpi for scenario in scenarios for kpi in scenario.outputs}


def _needs(kpi: str) -> bool:
    from opsim.kpi.names import needs_postures

    return needs_postures([kpi])


def _not_made(kpi: str) -> str:
    return f"{kpi}: it is made where the scenario's 'outputs' list it: add it there"


def _wrong(text: str, variants: Mapping[str, Any], made: set[str]) -> str:
    """What is wrong with one figure; nothing where all is well."""
    from opsim.kpi.better import read_asked
    from opsim.kpi.names import KPIS
    from opsim.problems import did_you_mean

    asked = read_asked(text)
    if asked.kpi not in KPIS:
        return f"no figure {asked.kpi!r}; {did_you_mean(asked.kpi, KPIS)}"
    if _needs(asked.kpi) and asked.kpi not in made:
        return _not_made(asked.kpi)
    if words := next(_subjects_wrong(asked, variants), ""):
        return words
    if not asked.better:
        said = f"write 'more {asked.name}' or 'less {asked.name}'"
        return f"{asked.name}: which way is better depends on who asks: {said}"
    return ""


def _subjects_wrong(asked: Any, variants: Mapping[str, Any]) -> Iterator[str]:
    """Where one of several things has to be named and none is, or one that is not there."""
    from opsim.kpi.subjects import subject_of
    from opsim.problems import did_you_mean

    kind = subject_of(asked.kpi)
    section = SECTIONS.get(kind)
    scenarios = [loaded.scenario for loaded in variants.values()]
    names = dict.fromkeys(name for scenario in scenarios for name in getattr(scenario, section or "", ()))
    if kind and not asked.subject and not asked.part:
        such = f", such as {asked.kpi}/{next(iter(names))}" if names else f": {asked.kpi}/NAME"
        yield f"{asked.kpi}: it is of each {kind}: say which{such}"
    if names and asked.subject and asked.subject not in (*names, "none"):
        yield f"{asked.name}: no {kind} {asked.subject!r}; {did_you_mean(asked.subject, names)}"

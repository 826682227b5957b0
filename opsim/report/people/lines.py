"""What was found of each task in one compact table, and of all tasks in a line."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from opsim.report.people.tables import KINDS

NOTHING, BOTH = "-", "posture + duration"
MOST_COVARIATES = 3
MEANING = {
    "ICC": "share of the variance that lies between people, with its 95 % interval (Shrout & Fleiss 1979, case 1; "
    "interval by Thomas & Hultquist 1978)",
    "known": "energy score of draws of the repetition's own worker, that repetition left out: small is good",
    "pooled": "of draws of that same fit which ask for nobody",
    "new": "of draws of new people, the repetition's worker left out whole",
    "R2 (p)": "what a covariate alone foretells of a person left out, below 0: worse than the others' mean does; "
    "how often noise does as well, * for less than 5 % with all quantities corrected for one another",
}
UNITS = (
    "Energy scores are over the mean distance of two repetitions, so that postures and log duration can be added; "
    "draws that know the task but not the worker come to about a half of each."
)


def title(one: Any) -> str:
    """Who was recorded."""
    return f"{one.task}: {len(one.names)} repetitions of {len(one.persons)} people ({one.selection})"


def compact(one: Any) -> tuple[list[str], list[list[str]]]:
    """Columns and rows of a task: scores of posture, duration and both; ICC and R2 of each quantity."""
    covariates = list(dict.fromkeys(told.covariate for told in one.told.told))[:MOST_COVARIATES]
    told = {(told.covariate, told.quantity): told for told in one.told.told}
    iccs = {found.quantity: found for found in one.iccs}
    scores = _scores(one.over_all)
    rows = []
    for quantity in dict.fromkeys([*scores, *iccs]):
        r2 = [_r2(told.get((name, quantity))) for name in covariates]
        rows.append([quantity, *scores.get(quantity, [NOTHING] * len(KINDS)), *_icc(iccs.get(quantity)), *r2])
    return ["", *KINDS, "ICC", "95 %", *(f"R2 {name} (p)" for name in covariates)], rows


def notes(one: Any) -> list[str]:
    """For whom knowing him did not help, and which covariates tell nothing."""
    judged = [person for person in one.persons if person.closer is not None]
    closer, unseen = [p.name for p in judged if p.closer], len(one.persons) - len(judged)
    if judged:
        others = [person.name for person in judged if not person.closer]
        found = [f"own draws are closer than pooled ones for {len(closer)} of {len(judged)} people"]
        found[0] += f", not for {', '.join(others)}" if others else ""
    else:
        found = ["nobody could be foretold by his own draws"]
    if unseen:
        found[0] += f"; {unseen} {'has' if unseen == 1 else 'have'} too few repetitions to be judged by"
    more = len({told.covariate for told in one.told.told}) - MOST_COVARIATES
    found += [f"{more} more covariates in covariates.csv"] if more > 0 else []
    return found + [f"covariate {note}" for note in one.told.notes]


def pairs(found: Sequence[Any]) -> tuple[int, int]:
    """(task, worker) pairs whose own draws are closer than pooled ones, of how many that were judged."""
    closer = [person.closer for one in found for person in one.persons if person.closer is not None]
    return sum(closer), len(closer)


def total(found: Sequence[Any]) -> str:
    """The line over all tasks."""
    closer, judged = pairs(found)
    if not judged:
        return "no (task, worker) pair could be judged"
    share = f"{100 * closer / judged:.0f} %"
    return f"own draws are closer than pooled ones for {closer} of {judged} (task, worker) pairs: {share}"


def overview(found: Sequence[Any]) -> tuple[list[str], list[list[str]]]:
    """A row for each task."""
    rows = []
    for one in found:
        closer, judged = pairs([one])
        both = _scores(one.over_all)[BOTH]
        icc = one.iccs[0]
        rows.append([one.task, str(len(one.persons)), str(len(one.names)), *_icc(icc), *both, f"{closer} of {judged}"])
    return ["task", "people", "repetitions", "ICC of log duration", "95 %", *KINDS, "own closer"], rows


def persons(one: Any) -> tuple[list[str], list[list[str]]]:
    """A row for each worker: scores of both together."""
    rows = [[p.name, str(p.n_repetitions), str(p.n_judged), *_scores(p)[BOTH], _yes(p.closer)] for p in one.persons]
    return ["worker", "repetitions", "judged", *KINDS, "own closer"], rows


def _scores(person: Any) -> dict[str, list[str]]:
    kinds = [getattr(person, kind) for kind in KINDS]
    return {
        BOTH: [_number(float(kind.sum())) for kind in kinds],
        "posture": [_number(float(kind[0])) for kind in kinds],
        "log duration": [_number(float(kind[1])) for kind in kinds],
    }


def _icc(found: Any) -> list[str]:
    if found is None or math.isnan(found.icc):
        return [NOTHING, NOTHING]
    return [_number(found.icc), f"{found.low:.2f} to {found.high:.2f}"]


def _r2(told: Any) -> str:
    return NOTHING if told is None else f"{told.r2:.2f} ({_number(told.p)}{'*' if told.kept else ''})"


def _yes(closer: bool | None) -> str:
    return NOTHING if closer is None else "yes" if closer else "no"


def _number(value: float) -> str:
    return NOTHING if math.isnan(value) else f"{value:.2f}"

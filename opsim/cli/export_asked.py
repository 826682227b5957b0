"""What ``opsim export`` is asked for: checked all at once, before anything is read or written."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

OCEL_JSON, OCEL_SQLITE, PARQUET, CSV, BVH = "ocel-json", "ocel-sqlite", "parquet", "csv", "bvh"
FORMATS = (OCEL_JSON, OCEL_SQLITE, PARQUET, CSV, BVH)
ENDINGS = {
    **dict.fromkeys((".jsonocel", ".json"), OCEL_JSON),
    **dict.fromkeys((".sqlite", ".sqlite3", ".db"), OCEL_SQLITE),
    **{".parquet": PARQUET, ".csv": CSV, ".bvh": BVH},
}
"""Which format an ending means, where nobody says."""
_ROWS, _OCEL = (PARQUET, CSV), (OCEL_JSON, OCEL_SQLITE)
_OF = {
    "worker": (BVH,),
    **dict.fromkeys(("task", "k", "walk", "at", "fps"), (BVH,)),
    "by_task": _OCEL,
    "figures": _ROWS,
    "date": (*_OCEL, *_ROWS),
}
"""Options that belong to some formats alone."""
_NUMBERS = re.compile(r"[0-9]{1,7}(-[0-9]{1,7})?(,[0-9]{1,7}(-[0-9]{1,7})?)*")


@dataclass(frozen=True)
class Asked:
    """What is to be written: variants by name, and of each the replications; options : the others, as they were said"""

    out: Path
    form: str
    variants: Mapping[str, Any]
    replications: tuple[int, ...]
    options: Mapping[str, Any]


def asked(
    results: Path, out: Path, form: str | None, scenarios: Sequence[str], said: str | None, **options: Any
) -> Asked:
    """Raises ValueError with everything that is wrong, OSError where the results cannot be read."""
    from opsim.cli.results_files import over_results
    from opsim.results import lacking_rows, variants_in

    held = variants_in(results)
    wrong: list[str] = []
    form = form or ENDINGS.get(out.suffix.lower(), "")
    if not form:
        wrong.append(f"{out}: found the ending {out.suffix!r}, expected one of {', '.join(ENDINGS)}; or say --format")
    wrong += _strange(form, options)
    variants = _variants(held, scenarios, wrong)
    gone = [] if options["figures"] else [words for name in variants if (words := lacking_rows(held[name]))]
    wrong += gone
    replications = () if gone else _replications(held, variants, said, form, wrong)
    if form == BVH:
        wrong += _one_performance(variants, replications, options)
    if options["figures"] and said is not None:
        wrong.append("--figures are of all replications: leave --replication out")
    wrong += _monday(options["date"])
    wrong += over_results(out, held)
    if out.is_dir():
        wrong.append(f"{out}: found a folder, expected a file to write")
    if wrong:
        raise ValueError("\n".join(wrong))
    return Asked(out, form, {name: held[name] for name in variants}, replications, options)


def _strange(form: str, options: Mapping[str, Any]) -> list[str]:
    """Options that were given and are of other formats, in words."""
    given = [name for name in _OF if options.get(name) not in (None, False)]
    return [
        f"--{name.replace('_', '-')} is for {' and '.join(_OF[name])}, not for {form}"
        for name in given
        if form and form not in _OF[name]
    ]


def _variants(held: Mapping[str, Any], scenarios: Sequence[str], wrong: list[str]) -> list[str]:
    from opsim.problems import did_you_mean, shown

    for name in scenarios:
        if name not in held:
            hint = did_you_mean(name, held, otherwise="there are")
            wrong.append(f"--scenario {shown(name)}: no such results; {hint}")
    return [name for name in held if not scenarios or name in scenarios]


def _replications(
    held: Mapping[str, Any], variants: list[str], said: str | None, form: str, wrong: list[str]
) -> tuple[int, ...]:
    """Those asked for; by default the first of what is a log of its own, all of what goes into one table."""
    most = min((len(held[name].events_files) for name in variants), default=0)
    if said is None:
        return (0,) if form in (*_OCEL, BVH) else ()
    if said == "all":
        return tuple(range(most)) if form in (*_OCEL, BVH) else ()
    if not _NUMBERS.fullmatch(said):
        wrong.append(f"--replication {said!r}: found no number, expected such as 3, 0-4, 0,2,5 or all")
        return ()
    found = sorted({n for part in said.split(",") for n in _range(part)})
    if not found or found[-1] >= most:
        wrong.append(f"--replication {said}: found none such, expected numbers from 0 to {most - 1}")
        return ()
    return tuple(found)


def _range(part: str) -> range:
    first, _, last = part.partition("-")
    return range(int(first), int(last or first) + 1)


def _monday(date: str | None) -> list[str]:
    from opsim.export.run_clock import monday_of

    try:
        if date is not None:
            monday_of(date)
    except ValueError as error:
        return [str(error)]
    return []


def _one_performance(variants: list[str], replications: tuple[int, ...], options: Mapping[str, Any]) -> list[str]:
    """What speaks against there being one performance to write."""
    wrong = []
    if len(variants) > 1:
        wrong.append(f"found several variants ({', '.join(variants)}), expected one for a .bvh: say --scenario")
    if len(replications) > 1:
        wrong.append("found several replications, expected one for a .bvh")
    if options["worker"] is None:
        wrong.append("found no --worker, expected whose performance it is")
    ways = [name for name in ("task", "walk", "at") if options[name] not in (None, False)]
    if len(ways) != 1:
        found = " and ".join(f"--{name}" for name in ways) or "none"
        wrong.append(f"found {found}, expected one of --task TASK --k N, --walk --k N, --at TIME")
    elif ways == ["at"] and options["k"] is not None:
        wrong.append("--k is for --task and --walk: --at says which by its time")
    return wrong

"""``opsim motion fit --cyclic``: recordings of walking or other cycles -> emulators of open length."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any


def read_cyclic(
    files: Sequence[str], task: str | None, where: str | None, wrong: Sequence[str], mapping_file: Path | None = None
) -> list[tuple[str, Any]]:
    """(task, recording) of each file, of the takes that ``where`` chooses. Raises ValueError with all mistakes."""
    from emulator.recordings.npz import read_recording

    wrong, found = [*wrong], []
    for file in files:
        name = task if task is not None and len(files) == 1 else Path(file).stem
        try:
            found.append((name, _chosen(read_recording(file, mapping_file=mapping_file), where)))
        except (ValueError, OSError) as error:
            wrong.append(f"{file}: {str(error).removeprefix(f'{file}: ')}")
    names = [name for name, _ in found]
    wrong += [f"two files give the task {name!r}; rename one" for name in sorted(set(names)) if names.count(name) > 1]
    if wrong:
        raise ValueError("\n".join(dict.fromkeys(wrong)))
    return found


def wrong_with_cyclic(**options: Any) -> list[str]:
    """Settings of the other kind of emulator that were given, in words."""
    return [
        f"--{name.replace('_', '-')}: found together with --cyclic, expected without: it belongs to repetitions"
        for name, value in options.items()
        if value
    ]


def cyclic_model(task: str, recording: Any, components: int | float | None, seed: int, where: str, said: str) -> Any:
    """The emulator of one recording, with progress. Raises ValueError in plain words."""
    from emulator.cyclic.model import CyclicEmulator
    from opsim.cli.progress import progress

    asked = {} if components is None else {"components": components}
    with progress(f"fit {task}") as report:
        return CyclicEmulator.fit(recording, task=task, seed=seed, where=where, command=said, progress=report, **asked)


def _chosen(recording: Any, where: str | None) -> Any:
    """The takes that fulfil the expression; None or "all": every one."""
    from emulator.recordings.selection import rows_where

    if where in (None, "all"):
        return recording
    takes = recording.takes
    shared = set.intersection(*(set(take.covariates) for take in takes))
    columns: dict[str, list[Any]] = {key: [take.covariates[key] for take in takes] for key in sorted(shared)}
    columns |= {
        "worker": [take.worker for take in takes],
        "trial": [take.trial for take in takes],
        "duration_s": [take.duration_s for take in takes],
    }
    kept = tuple(take for take, keep in zip(takes, rows_where(str(where), columns)) if keep)
    if not kept:
        raise ValueError(f"no take fulfils {where!r}")
    return replace(recording, takes=kept)

"""What ``opsim motion clean`` says: a table, sentences, the rows of a CSV, JSON."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import Any

import click

MOST_ROWS = 40
COLUMNS = ("kind", "joints", "first_frame", "last_frame", "size", "unit", "mended", "bad", "words")


def cells(repair: Any) -> list[Any]:
    values = {column: getattr(repair, column) for column in COLUMNS}
    return [*(values | {"joints": " ".join(repair.joints), "size": f"{repair.size:.6g}"}).values()]


def verdicts_of(done: Any) -> str:
    counts = Counter(done.verdict(name) for name in done.names)
    takes = f"{len(done.names)} take{'s' * (len(done.names) > 1)}"
    order = ("good", "told", "repaired", "bad", "left out")
    return f"{takes}: {', '.join(f'{counts[word]} {word}' for word in order if counts[word])}"


def notes_of(done: Any) -> list[str]:
    mended = Counter(repair.kind for repair in done.repairs if repair.mended)
    told = Counter(repair.kind for repair in done.repairs if not repair.mended)
    said = [f"{word}: {', '.join(f'{n} {kind}' for kind, n in counts.items())}" for word, counts in
            (("mended", mended), ("left as it is", told)) if counts]  # fmt: skip
    return ["; ".join(said) or "nothing was found", _change(done)]


def change_mm(done: Any) -> list[float]:
    """How far joints were moved, mean over joints and frames of each take, in mm, where both were seen."""
    import numpy as np

    moved = []
    for name, before, after in done.pairs():
        start = done.first_frame(name)
        away = np.linalg.norm(after.positions_m - before.positions_m[start : start + after.n_frames], axis=-1)
        moved.append(1000 * float(np.nanmean(away)) if np.isfinite(away).any() else 0.0)
    return moved


def _change(done: Any) -> str:
    import numpy as np

    moved = change_mm(done)
    most = f"{max(moved):.2g} mm in the one changed most"
    return f"joints moved by {np.median(moved):.2g} mm in the median take, {most} (mean over joints and frames)"


def tell(done: Any, file: str, out: Path, repairs: Path | None, pictures: list[Path], as_json: bool) -> None:
    from opsim.cli.console import print_json

    if as_json:
        print_json(_as_json(done, out, repairs, pictures))
        return
    _table(done, f"{Path(file).name}: {verdicts_of(done)}")
    for name, why in done.left_out:
        click.echo(f"left out {name}: {why}")
    click.echo(_change(done))
    for what, path in (("recording", out), ("repairs", repairs), *(("picture", picture) for picture in pictures)):
        if path is not None:
            click.echo(f"{what}: {path}")


def _table(done: Any, title: str) -> None:
    from emulator.cleaning import KINDS
    from opsim.cli.console import print_table
    from opsim.cli.motion_clean_view import size_words

    kinds = [kind for kind in KINDS if any(repair.kind == kind for repair in done.repairs)]
    rows = []
    names = [name for name in done.names if len(done.names) <= MOST_ROWS or done.verdict(name) != "good"]
    for name in names[: 5 * MOST_ROWS]:
        cells = []
        for kind in kinds:
            found = [repair for repair in done.of(name) if repair.kind == kind]
            most = max(found, key=lambda repair: repair.size, default=None)
            many = f"{len(found)} x " if len(found) > 1 else ""
            cells.append("" if most is None else many + size_words(most.size, most.unit))
        rows.append((name, done.verdict(name), *cells))
    if len(rows) < len(done.names):
        rows.append((f"and {len(done.names) - len(rows)} more", "", *[""] * len(kinds)))
    click.echo(title)
    print_table("", ("take", "verdict", *kinds), rows, words=2)


def _as_json(done: Any, out: Path, repairs: Path | None, pictures: list[Path]) -> dict[str, Any]:
    return {
        "out": str(out),
        "repairs_file": None if repairs is None else str(repairs),
        "pictures": [str(picture) for picture in pictures],
        "takes": [
            {"take": name, "verdict": done.verdict(name), "found": dict(Counter(r.kind for r in done.of(name)))}
            for name in done.names
        ],
        "repairs": [
            {"take": r.take, **{c: getattr(r, c) for c in COLUMNS}, "joints": list(r.joints)} for r in done.repairs
        ],
        "moved_mm": dict(zip([name for name, _, _ in done.pairs()], change_mm(done))),
    }

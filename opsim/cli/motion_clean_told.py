"""What ``opsim motion clean`` says: a table, sentences, the rows of a CSV, JSON."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import click

MOST_ROWS = 40
COLUMNS = ("kind", "joints", "first_frame", "last_frame", "size", "unit", "mended", "bad", "shortens", "words")


def cells(repair: Any) -> list[Any]:
    values = {column: getattr(repair, column) for column in COLUMNS}
    return [*(values | {"joints": " ".join(repair.joints), "size": f"{repair.size:.6g}"}).values()]


def verdicts_of(done: Any) -> str:
    """How many takes of each verdict, what was told of repaired ones and what is gone of shortened ones added."""
    from opsim.report.cleaned import headline

    counts = Counter(headline(done.verdict(name)) for name in done.names)
    takes = f"{len(done.names)} take{'s' * (len(done.names) > 1)}"
    order = ("good", "told", "repaired", "shortened", "bad", "left out")
    return f"{takes}: {', '.join(f'{counts[word]} {word}{_more(done, word)}' for word in order if counts[word])}"


def _more(done: Any, word: str) -> str:
    odd = sum(done.verdict(name) == f"{word}, told" for name in done.names)
    added = [f"{odd} of them told"] if odd else []
    if word == "shortened":
        longest = max(sum(r.size for r in done.of(name) if r.shortens) for name in done.names)
        added.insert(0, f"by up to {longest:.2f} s")
    return f" ({'; '.join(added)})" if added else ""


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
    said = f"joints moved by {np.median(moved):.2g} mm in the median take, {most} (mean over joints and frames)"
    cut = [repair for repair in done.repairs if repair.kind == "cut" and repair.take not in dict(done.left_out)]
    takes = len({repair.take for repair in cut})
    gone = f"; {sum(r.size for r in cut):.2f} s cut off {takes} take{'s' * (takes > 1)}"
    return said + gone if cut else said


def tell(
    done: Any, file: str, out: Path, repairs: Path | None, pictures: list[Path], as_json: bool, dropped: Sequence[str]
) -> None:
    from opsim.cli.console import print_json

    if as_json:
        print_json(_as_json(done, out, repairs, pictures) | {"dropped": list(dropped)})
        return
    _table(done, f"{Path(file).name}: {verdicts_of(done)}")
    for name, why in done.left_out:
        click.echo(f"left out {name}: {why}")
    for line in dropped:
        click.echo(line)
    click.echo(_change(done))
    for what, path in (("recording", out), ("repairs", repairs), *(("picture", picture) for picture in pictures)):
        if path is not None:
            click.echo(f"{what}: {path}")


def _table(done: Any, title: str) -> None:
    from opsim.cli.console import print_table
    from opsim.cli.motion_clean_view import view_of
    from opsim.report.cleaned import cell

    view = view_of(done, title, [], panels=False)
    cards = [card for card in view.cards if len(view.cards) <= MOST_ROWS or card.verdict != "good"]
    rows = [
        (card.name, card.verdict, *(cell([f for f in card.findings if f.of == name]) for name in view.columns))
        for card in cards[: 5 * MOST_ROWS]
    ]
    if len(rows) < len(done.names):
        rows.append((f"and {len(done.names) - len(rows)} more", "", *[""] * len(view.columns)))
    click.echo(title)
    print_table("", ("take", "verdict", *view.columns), rows, words=2)
    if any(" x " in words for row in rows for words in row[2:]):
        click.echo("4 x 1.2 cm: four of them, the largest 1.2 cm; left: found, and left as it is")


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

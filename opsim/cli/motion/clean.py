"""What ``opsim motion clean`` says: a table, sentences, the rows of a CSV, JSON.

``opsim motion clean``: what is wrong with a recording found, mended where it can be, and shown.
"""

from __future__ import annotations

import csv
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import click

from opsim.cli.app import Mistake, mistakes

MOST_ROWS = 40
COLUMNS = ("kind", "joints", "first_frame", "last_frame", "size", "unit", "mended", "bad", "shortens", "words")


def cells(repair: Any) -> list[Any]:
    values = {column: getattr(repair, column) for column in COLUMNS}
    return [*(values | {"joints": " ".join(repair.joints), "size": f"{repair.size:.6g}"}).values()]


def verdicts_of(done: Any) -> str:
    """How many takes of each verdict, what was told of repaired ones and what is gone of shortened ones added."""
    from opsim.report.motion.cleaning import headline

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
    from opsim.cli.app import print_json

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
    from opsim.cli.app import print_table
    from opsim.cli.motion.clean_page import view_of
    from opsim.report.motion.cleaning import cell

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


@click.command("clean")
@click.argument("file", metavar="FILE.npz")
@click.option("-o", "--out", type=click.Path(path_type=Path), required=True, help="The recording to write, .npz.")
@click.option("--strict", is_flag=True, help="Refuse, with a list, what would have to be mended; nothing is written.")
@click.option("--drop-bad", is_flag=True, help="Leave out takes that are bad (a fault was left) or shortened.")
@click.option(
    "--set",
    "given",
    multiple=True,
    metavar="NAME=VALUE",
    help="A setting, such as bones=mend, low_pass=off or cut_off_hz=6; may be given several times.",
)
@click.option("--repairs", type=click.Path(path_type=Path), help="Everything that was found, as .csv.")
@click.option("--no-pictures", is_flag=True, help="Without OUT.clean.svg and OUT.clean.html.")
@click.option("--json", "as_json", is_flag=True, help="JSON for machines.")
def command(
    file: str,
    out: Path,
    strict: bool,
    drop_bad: bool,
    given: tuple[str, ...],
    repairs: Path | None,
    no_pictures: bool,
    as_json: bool,
) -> None:
    """Clean a recording FILE: units, swaps, jumps, gaps, slips, bones, offsets, angles, noise; say what was done.

    \b
    Settings and what each may be (the first unless set):
      swaps, jumps, slips       mend, tell, off
      gaps                      mend, cut
      low_pass                  mend, off
      bones, offsets, angles    tell, mend, off
      heading, holds            tell, off
      plausible                 refuse, off
    and numbers such as cut_off_hz, bridged_gap_s, tolerance_deg (emulator.cleaning.CleaningSettings).
    """
    from opsim.cli.motion.files import no_empty_folders, ready

    pictures = [] if no_pictures else [out.with_suffix(f".clean{ending}") for ending in (".svg", ".html")]
    with mistakes():
        settings, recording = _asked(file, out, repairs, given)
    done = _cleaned(file, recording, settings)
    if strict:
        _refuse(file, done)
    with mistakes(), no_empty_folders(out.parent):
        ready(out, ".npz")
        if repairs is not None:
            ready(repairs, ".csv")
        recording, dropped = _kept(done, drop_bad)
        _write(done, recording, file, out, repairs, pictures)
    tell(done, file, out, repairs, pictures, as_json, dropped)


def _asked(file: str, out: Path, repairs: Path | None, given: tuple[str, ...]) -> tuple[Any, Any]:
    """Settings and recording. Raises ValueError with everything that speaks against the call."""
    from emulator.cleaning import settings_of
    from emulator.cleaning.settings import beyond_rate
    from emulator.recordings.npz import read_recording
    from opsim.cli.motion.files import of_another_kind, overwritten

    wrong = [] if out.suffix.lower() == ".npz" else [f"{out}: found the ending {out.suffix!r}, expected .npz"]
    wrong += overwritten(out, recording=[file]) or of_another_kind(out, "recording")
    if repairs is not None and repairs.suffix.lower() != ".csv":
        wrong.append(f"{repairs}: found the ending {repairs.suffix!r}, expected .csv")
    settings = recording = None
    values, unread = _values(given)
    wrong += unread
    try:
        settings = settings_of(values)
    except ValueError as error:
        wrong += [f"--set: {line}" for line in str(error).splitlines()]
    try:
        recording = read_recording(file)
    except (ValueError, OSError) as error:
        wrong.append(str(error))
    if recording is not None:
        wrong += [f"--set: {line}" for line in beyond_rate(values.get("cut_off_hz"), recording.rate_hz)]
    if wrong:
        raise ValueError("\n".join(wrong))
    return settings, recording


def _values(given: tuple[str, ...]) -> tuple[dict[str, Any], list[str]]:
    """Names and values of ``--set``; numbers as such."""
    values: dict[str, Any] = {}
    wrong = []
    for each in given:
        name, is_there, value = each.partition("=")
        if not is_there:
            wrong.append(f"--set: found {each!r}, expected NAME=VALUE")
            continue
        try:
            values[name.strip()] = float(value)
        except ValueError:
            values[name.strip()] = value.strip()
    return values, wrong


def _cleaned(file: str, recording: Any, settings: Any) -> Any:
    from emulator.cleaning import cleaned
    from opsim.cli.progress import progress

    with progress(f"clean {Path(file).stem}") as report:
        try:
            return cleaned(recording, settings, report)
        except ValueError as error:
            raise Mistake("\n".join(f"{file}: {line}" for line in str(error).splitlines())) from None


def _refuse(file: str, done: Any) -> None:
    """Say everything that is wrong, and stop."""
    wrong = [repair for repair in done.repairs if repair.mended or repair.bad]
    wrong_takes = len({repair.take for repair in wrong})
    if wrong:
        head = f"{file}: --strict: found {len(wrong)} faults in {wrong_takes} of {len(done.names)} takes, expected none"
        lines = [f"  {str(repair).removesuffix(repair.words)}{repair.found}" for repair in wrong]
        raise Mistake("\n".join([head, *lines]))


def _kept(done: Any, drop_bad: bool) -> tuple[Any, list[str]]:
    """The recording to write, and what is said of takes not in it. Raises ValueError where none is left."""
    from dataclasses import replace

    from opsim.report.motion.cleaning import headline

    if not drop_bad:
        return done.recording, []
    verdict = {name: headline(done.verdict(name)) for name, _, _ in done.pairs()}
    takes = [after for name, _, after in done.pairs() if verdict[name] not in ("bad", "shortened")]
    if not takes:
        raise ValueError(f"--drop-bad: found a fault in all of {len(done.names)} takes, expected one without")
    notes = []
    for word, why in (("bad", "faults that stay"), ("shortened", "frames of the movement that are gone")):
        dropped = [name for name in verdict if verdict[name] == word]
        notes += [f"left out for {why}: {', '.join(dropped)}"] if dropped else []
    return replace(done.recording, takes=tuple(takes), notes=(*done.recording.notes, *notes)), notes


def _write(done: Any, recording: Any, file: str, out: Path, repairs: Path | None, pictures: list[Path]) -> None:
    """The recording, then the repairs, then the pictures; a stop says which of them are there."""
    from emulator.recordings.npz import write_recording
    from opsim.cli.app import stopped, stops_once, written_so_far

    wanted = [out, *([] if repairs is None else [repairs]), *pictures]
    written: list[Path] = []
    with stops_once():
        try:
            write_recording(recording, out)
            written.append(out)
            if repairs is not None:
                _write_repairs(done, repairs)
                written.append(repairs)
            _draw(done, file, pictures)
        except KeyboardInterrupt as error:
            raise stopped(error, written_so_far(written, wanted)) from None


def _write_repairs(done: Any, repairs: Path) -> None:
    from opsim.files import whole_file

    with whole_file(repairs) as temporary, temporary.open("w", newline="", encoding="utf-8") as stream:
        table = csv.writer(stream)
        table.writerow(["take", "verdict", *COLUMNS])
        table.writerows([r.take, done.verdict(r.take), *cells(r)] for r in done.repairs)


def _draw(done: Any, file: str, pictures: list[Path]) -> None:
    from opsim.cli.motion.clean_page import view_of
    from opsim.cli.progress import progress
    from opsim.report.motion.cleaning_charts import write_cleaned

    if not pictures:
        return
    with progress("draw") as report:
        report(0, 1)
        write_cleaned(view_of(done, f"{Path(file).stem}: {verdicts_of(done)}", notes_of(done)), *pictures)
        report(1, 1)

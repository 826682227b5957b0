"""``opsim motion segment``: a long take cut into repetitions or cycles, by itself or by given cut times."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from opsim.cli.app import mistakes

PICTURED = 4
"""Takes that the picture shows."""


@click.command("segment")
@click.argument("file", metavar="FILE.npz")
@click.option("-o", "--out", type=click.Path(path_type=Path), required=True, help="The recording to write, .npz.")
@click.option("--repetitions", "kind", flag_value="repetitions", help="Away from a posture of rest and back to it.")
@click.option("--cycles", "kind", flag_value="cycles", help="What goes on without a rest, such as walking.")
@click.option(
    "--cuts", type=click.Path(path_type=Path), help="Cut at these times instead: a file as this command writes it."
)
@click.option("--k", type=int, help="Neighbours of a frame for the manifold.  [default: one cycle and a quarter]")
@click.option("--json", "as_json", is_flag=True, help="JSON for machines.")
def command(file: str, out: Path, kind: str | None, cuts: Path | None, k: int | None, as_json: bool) -> None:
    """Cut each take of FILE into pieces, each a take of OUT: as many as there are, no number is asked for.

    Where neither --repetitions nor --cycles is said, takes with rests between are cut into repetitions, others into
    cycles. Beside OUT.npz: OUT.cuts.txt, cut times to correct by hand and give back with --cuts; OUT.segment.svg.

    \b
    The table says of each take:
      pieces         how many repetitions or cycles it was cut into
      units, frames  of a take of cycles, how many frames it gets ready (preparing), sets off (initial), repeats
                     itself (cyclic), runs out (final) and stands again (wind-up)
      dimension      how many numbers tell one posture of the movement from another: 1 where it runs along one
                     line or ring and comes back the same way, more where it varies or swings in several ways
    """
    from opsim.cli.motion.files import no_empty_folders, ready

    with mistakes():
        recording, asked = _read(file, out, cuts, kind)
    with no_empty_folders(out.parent), mistakes():
        ready(out, ".npz")
        found, missed = _found(recording, asked, kind or "auto", k)
        written = _write(recording, found, file, out, cuts)
    said = [] if len(found) <= PICTURED else [f"the picture shows the first {PICTURED} of {len(found)} takes"]
    rows = [_row(segments) for segments in found]
    if as_json:
        from opsim.cli.app import print_json

        print_json({"files": written, "takes": rows, "not_cut": missed, "notes": _notes(found)})
    else:
        _print(rows, missed, [*_notes(found), *said], written)


def _read(file: str, out: Path, cuts: Path | None, kind: str | None) -> tuple[Any, Any]:
    """The recording, and the cuts of each of its takes where they are given. Raises ValueError, everything at once."""
    from emulator.recordings.npz import read_recording
    from emulator.segmenting.repetitions import postures
    from emulator.segmenting.segment import parse_cut_times
    from opsim.cli.motion.files import of_another_kind, overwritten

    read: dict[str, list[str | Path]] = {"recording": [file], "cut_times": [] if cuts is None else [cuts]}
    wrong = [] if out.suffix.lower() == ".npz" else [f"{out}: found the ending {out.suffix!r}, expected .npz"]
    wrong += overwritten(out, **read) or of_another_kind(out, "recording")
    wrong += overwritten(out.with_suffix(".segment.svg"), **read)
    if cuts is not None and kind is not None:
        wrong.append(f"--{kind}: found together with --cuts, expected one of them")
    recording, given = None, None
    try:
        recording = read_recording(file)
    except (ValueError, OSError) as error:
        wrong.append(_said(error))
    if recording is not None and cuts is None:
        for take in recording.takes:
            try:
                postures(take)
            except ValueError as error:
                wrong.append(f"{file}: {error}")
        wrong += _edited(out.with_suffix(".cuts.txt"))
    if recording is not None and cuts is not None:
        try:
            given = parse_cut_times(_text(cuts), recording.takes, str(cuts))
        except (ValueError, OSError) as error:
            wrong.append(_said(error))
    if wrong:
        raise ValueError("\n".join(wrong))
    return recording, given


def _edited(beside: Path) -> list[str]:
    """What speaks against writing cut times: those that somebody has corrected are there."""
    from emulator.segmenting.segment import was_edited

    if not beside.is_file() or not was_edited(beside.read_text(encoding="utf-8", errors="replace")):
        return []
    return [f"{beside}: found cut times that were edited, expected --cuts {beside} to use them, or another -o"]


def _text(file: Path) -> str:
    if file.is_dir():
        raise ValueError(f"{file}: found a folder, expected a file of cut times")
    try:
        return file.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError as error:
        raise ValueError(f"{file}: found bytes that are no UTF-8 text (at {error.start}), expected cut times") from None


def _said(error: Exception) -> str:
    if isinstance(error, OSError) and error.strerror:
        return f"{error.filename}: {error.strerror}"
    return str(error)


def _found(recording: Any, asked: Any, kind: str, k: int | None) -> tuple[list[Any], list[str]]:
    """What each take was cut into, and the takes in which nothing was found. Raises ValueError where that is all."""
    from emulator.segmenting.segment import NothingFound, given, segment
    from opsim.cli.progress import progress

    if asked is not None:
        return [given(take, asked[take.name]) for take in recording.takes if take.name in asked], []
    found, missed = [], []
    with progress("segment") as report:
        for number, take in enumerate(recording.takes):
            try:
                found.append(segment(take, kind, k=k))
            except NothingFound as error:
                missed.append(str(error))
            report(number + 1, len(recording.takes))
    if not found:
        raise ValueError("\n".join([*missed[:10], "nothing was cut; cut times can be given with --cuts FILE.txt"]))
    return found, missed


def _write(recording: Any, found: list[Any], file: str, out: Path, cuts: Path | None) -> dict[str, str]:
    """The pieces, the cut times (where they were not given) and the picture; where each of them is."""
    from emulator.recordings.npz import write_recording
    from emulator.segmenting.segment import cut_recording, cut_times_text
    from opsim.cli.app import stopped, stops_once, written_so_far
    from opsim.cli.motion.segment_page import picture
    from opsim.files import whole_file

    times, shown = out.with_suffix(".cuts.txt"), out.with_suffix(".segment.svg")
    wanted = {"recording": out} | ({} if cuts else {"cut_times": times}) | {"picture": shown}
    said = f"cut from {Path(file).name}" + (f" at the times of {cuts.name}" if cuts else "")
    written: list[Path] = []
    with stops_once():
        try:
            write_recording(cut_recording(recording, found, said), out)
            written.append(out)
            if cuts is None:
                text = cut_times_text(recording.takes, {segments.take.name: segments.cuts for segments in found})
                with whole_file(times) as temporary:
                    temporary.write_text(text, encoding="utf-8")
                written.append(times)
            picture(found[:PICTURED], len(found), shown)
        except KeyboardInterrupt as error:
            raise stopped(error, written_so_far(written, [*wanted.values()])) from None
    return {what: str(path) for what, path in wanted.items()}


def _row(segments: Any) -> dict[str, Any]:
    take, curve = segments.take, segments.curve
    return {
        "take": take.name,
        "frames": take.n_frames,
        "seconds": round(take.duration_s, 3),
        "kind": segments.kind,
        "pieces": len(segments.cuts),
        "units": {unit.name: unit.n_frames for unit in segments.units},
        "dimension": None if curve is None else curve.dimension,
    }


def _notes(found: list[Any]) -> list[str]:
    """What was left out of each take, and where what was cut may be no repetitions."""
    said = [f"take {segments.take.name}: left out {note}" for segments in found for note in segments.notes]
    return said + [doubt for segments in found if (doubt := _doubt(segments))]


def _doubt(segments: Any) -> str:
    from emulator.segmenting.segment import rests_between

    if segments.repetitions is None or len(segments.cuts) < 2 or rests_between(segments.repetitions):
        return ""
    between = segments.repetitions.rests[1:-1]
    return (
        f"take {segments.take.name}: no rest found at {int((~between).sum())} of the {len(between)} places between "
        "its repetitions; --cycles is meant for movement that goes on without one, such as walking"
    )


def _print(rows: list[dict[str, Any]], missed: list[str], notes: list[str], written: dict[str, str]) -> None:
    from opsim.cli.app import print_table, printable

    columns = ("take", "cut into", "pieces", "frames", "seconds", "units, frames", "dimension")
    cells = [
        (
            row["take"],
            row["kind"],
            str(row["pieces"]),
            str(row["frames"]),
            f"{row['seconds']:.2f}",
            "|".join(str(n) for n in row["units"].values()) or "-",
            "-" if row["dimension"] is None else str(row["dimension"]),
        )
        for row in rows
    ]
    total = sum(row["pieces"] for row in rows)
    print_table(f"{total} pieces of {len(rows)} take{'s' if len(rows) > 1 else ''}", columns, cells, words=2)
    if any(row["units"] for row in rows):
        click.echo("units, frames: preparing|initial|cyclic|final|wind-up, how many frames of the take are each")
    if any(row["dimension"] is not None for row in rows):
        click.echo("dimension: how many numbers tell one posture of the movement from another; 1 is one line or ring")
    for line in [*missed, *notes]:
        click.echo(printable(line), err=True)
    for what, where in written.items():
        click.echo(f"{what.replace('_', ' ')}: {where}")
    if "cut_times" in written:
        times, out = written["cut_times"], written["recording"]
        click.echo(f"to correct the cuts, edit {times} and run again with --cuts {times} -o {out}")

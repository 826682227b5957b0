"""``opsim motion import``: files of capture systems -> one recording with canonical joints, and a picture of it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import click

from opsim.cli.verbs import mistakes


@click.command("import")
@click.argument("files", nargs=-1, required=True, metavar="FILE...")
@click.option(
    "-o", "--out", type=click.Path(path_type=Path), required=True, help="The recording to write, a .npz file."
)
@click.option("--unit", metavar="UNIT", help="m, cm, mm, inch, ft, or metres a unit.  [default: found]")
@click.option("--up", metavar="AXIS", help="The axis that points up: x, y, z, -x, -y or -z.  [default: found]")
@click.option("--rate", metavar="HZ", help="Frames a second, where the file does not say.")
@click.option(
    "--columns",
    metavar="FILE",
    help="Names of the points of a CSV without header or a JSON without names: a file with a name a line; or "
    "plug-in-gait, coco-17, body-25, halpe-26, blazepose-33, kinect-20, kinect-25, kinect-32.",
)
@click.option("--map", "mapping_file", metavar="FILE", help="Lines 'name in the file: joint' for names not known here.")
@click.option("--asf", metavar="FILE", help="The skeleton of an AMC.  [default: the one beside it]")
@click.option("--min-score", metavar="SHARE", help="Keypoints of less confidence become gaps.  [default: 0.3]")
@click.option(
    "--sides",
    metavar="swap|mirror|keep",
    help="Where left and right are exchanged: exchange the names, mirror the axes, or keep them.",
)
@click.option("--worker", metavar="NAME", help="Who was recorded.  [default: by the file's name]")
@click.option("--trial", metavar="NAME", help="Which take it is, for one FILE.  [default: by the file's name]")
@click.option("--names", "names_as", metavar="PATTERN", help="How files are named, such as 'HDM_{worker}_*_{trial}_*'.")
@click.option("--source", help="Where the recording is from; kept in it.  [default: the names of the files]")
@click.option("--licence", help="Its licence; kept in it.  [default: not stated]")
@click.option("--picture", type=click.Path(path_type=Path), help=".svg or .png.  [default: OUT.import.svg]")
@click.option("--json", "as_json", is_flag=True, help="JSON for machines.")
def command(files: tuple[str, ...], out: Path, as_json: bool, **options: Any) -> None:
    """Read each FILE of a capture system (BVH, ASF/AMC, C3D, TRC, CSV, JSON) and write all takes as one recording.

    Units and axes are found from the body, joints are renamed to the canonical ones, left and right are checked.
    A folder of *_keypoints.json (OpenPose, a file a frame) is a FILE too.
    """
    from opsim.cli.motion_files import no_empty_folders, ready
    from opsim.cli.motion_import_asked import asked_of

    with mistakes():
        asked = asked_of(files, out, options)
        found, recording = _read(files, asked)
    with no_empty_folders(out.parent), mistakes():
        ready(out, ".npz")
        ready(asked.picture, ".svg", ".png")
        _write(found, recording, out, asked.picture)
    _tell(found, recording, out, asked.picture, as_json)


def _read(files: Sequence[str], asked: Any) -> tuple[list[Any], Any]:
    """What was found in every file, and the recording. Raises RecordingError with the mistakes of all files."""
    from emulator.recordings import RecordingError
    from emulator.recordings.importing import imported, together
    from opsim.cli.progress import progress

    found: list[Any] = []
    wrong: list[str] = []
    with progress("import") as report:
        for i, file in enumerate(files):
            try:
                found += imported(file, **asked.options)
            except (ValueError, OSError) as error:
                wrong.append(_said_of(file, error))
            report(i + 1, len(files), Path(file).name)
    if wrong:
        raise RecordingError("\n".join(wrong))
    return found, together(found, asked.source, asked.licence)


def _said_of(file: str, error: Exception) -> str:
    """What is wrong with a file; the file's name stands in it."""
    text = (error.strerror if isinstance(error, OSError) else None) or str(error)
    from emulator.recordings import RecordingError

    return text if isinstance(error, RecordingError) else f"{file}: cannot be read: {text}"


def _write(found: Sequence[Any], recording: Any, out: Path, picture: Path) -> None:
    from emulator.recordings.npz import write_recording
    from opsim.report.import_picture import Shown, draw_import

    shown = [
        Shown(
            title=_title(each),
            said=_said(each),
            names=each.take.names,
            parents=each.take.parents,
            positions_m=each.take.positions_m,
            rate_hz=each.take.rate_hz,
            bone_m=each.bone_m,
            spread_m=each.spread_m,
        )
        for each in found
    ]
    drawn = draw_import(shown, picture.suffix.lower().lstrip("."))
    write_recording(recording, out)
    picture.write_bytes(drawn)


def _title(each: Any) -> str:
    """The file, and who and which take where its name does not say that already."""
    file, take = Path(each.file), each.take
    name = take.worker if take.trial == file.stem else take.name
    return file.name if name == "unknown" else f"{file.name}: {name}"


def _said(each: Any) -> str:
    take = each.take
    found = [note.split(" (")[0] for note in each.notes if note.startswith(("unit", "up axis", "the body"))]
    tall = [f"{each.body_m:.2f} m from head to feet"] if math.isfinite(each.body_m) else []
    frames = f"{each.format}, {take.n_frames} frames at {take.rate_hz:g} Hz, {take.duration_s:.2f} s"
    return "\n".join(["; ".join([frames, *found, *tall]), f"{each.mapping.summary()}; sides {each.sides.verdict}"])


def _tell(found: Sequence[Any], recording: Any, out: Path, picture: Path, as_json: bool) -> None:
    from opsim.cli.console import print_json, print_table

    rows = [_row(each) for each in found]
    if as_json:
        print_json({"recording": str(out), "picture": str(picture), "takes": rows, "notes": list(recording.notes)})
        return
    columns = (
        "file",
        "take",
        "format",
        "sides",
        "body",
        "frames",
        "seconds",
        "Hz",
        "joints",
        "made",
        "left out",
        "gaps",
    )
    table = [
        (
            row["file"], row["take"], row["format"], row["sides"], _metres(row["body_m"]), f"{row['frames']}",
            f"{row['seconds']:.2f}", f"{row['rate_hz']:g}", f"{len(row['joints'])}", f"{len(row['made'])}",
            f"{len(row['left_out']) + len(row['unknown'])}", f"{row['gap_share']:.2%}",
        )
        for row in rows
    ]  # fmt: skip
    print_table("imported", columns, table, words=4)
    _tell_notes(found)
    for row in rows:
        for name, near in row["unknown"].items():
            click.echo(f"{row['file']}: not known: {name}{near}; name it with --map")
    click.echo(f"recording: {out} ({out.stat().st_size / 1e6:.2f} MB, {len(rows)} take{'s' if len(rows) > 1 else ''})")
    click.echo(f"picture: {picture}")


def _metres(value: float) -> str:
    return f"{value:.2f} m" if math.isfinite(value) else "-"


def _tell_notes(found: Sequence[Any]) -> None:
    """Each note once, under the files that it is about; of several files without the figures in brackets."""
    every = list(dict.fromkeys(Path(each.file).name for each in found))
    about: dict[str, list[str]] = {}
    short = (lambda note: note) if len(every) == 1 else (lambda note: note.partition(" (")[0])
    for note, file in dict.fromkeys((short(note), Path(each.file).name) for each in found for note in each.notes):
        about.setdefault(note, []).append(file)
    told: dict[str, list[str]] = {}
    for note, files in about.items():
        many = f"{len(files)} files ({', '.join(files[:3])}{', ...' if len(files) > 3 else ''})"
        of = files[0] if len(files) == 1 else "all files" if files == every else many
        told.setdefault(of, []).append(note)
    for of in sorted(told, key=lambda each: each != "all files"):
        click.echo("\n  ".join([f"{of}:", *told[of]]))


def _row(each: Any) -> dict[str, Any]:
    take, mapping = each.take, each.mapping
    return {
        "file": Path(each.file).name,
        "take": take.name,
        "format": each.format,
        "frames": take.n_frames,
        "seconds": round(take.duration_s, 6),
        "rate_hz": take.rate_hz,
        "joints": list(take.names),
        "made": {row.joint: row.why for row in mapping.of("made")},
        "left_out": {row.name: row.why for row in mapping.of("left out")},
        "unknown": {row.name: f" ({row.why})" if row.why else "" for row in mapping.of("unknown")},
        "sides": each.sides.verdict,
        "body_m": each.body_m,
        "witnesses": {name: round(value, 3) for name, value in each.sides.witnesses.items()},
        "gap_share": float(each.gap_share.mean()),
    }

"""``opsim motion import``: files of capture systems -> one recording with canonical joints, and a picture of it.

What is asked of ``opsim motion import``, and everything that speaks against it, said at once.
"""

from __future__ import annotations

import math
import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import click

from opsim.cli.app import mistakes


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
    from opsim.cli.motion.files import no_empty_folders, ready

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
    from opsim.report.motion.importing import Shown, draw_import

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
    from opsim.cli.app import print_json, print_table

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


@dataclass(frozen=True)
class ImportAsked:
    """``options`` are those of ``emulator.recordings.importing.imported``."""

    options: dict[str, Any]
    picture: Path
    source: str | None
    licence: str | None


def asked_of(files: Sequence[str], out: Path, given: dict[str, Any]) -> ImportAsked:
    """The options as the readers take them. Raises ValueError with all that is wrong."""
    from emulator.recordings.importing import SIDES
    from emulator.recordings.orientation import AXES
    from emulator.recordings.take import wrong_pattern

    wrong = _wrong_files(files, out, given)
    unit_m, wrong_unit = _unit(given["unit"])
    rate_hz, wrong_rate = _number("--rate", given["rate"], 1.0, 10_000.0, "frames a second")
    min_score, wrong_score = _number("--min-score", given["min_score"], 0.0, 1.0, "a number")
    wrong += [*wrong_unit, *wrong_rate, *wrong_score]
    wrong += _one_of("--up", given["up"], AXES) + _one_of("--sides", given["sides"], SIDES)
    if given["names_as"] is not None and (wrong_name := wrong_pattern(given["names_as"])):
        wrong.append(wrong_name)
    if given["trial"] is not None and len(files) > 1:
        wrong.append(f"--trial {given['trial']}: found {len(files)} files, expected one; see --names")
    for name in ("worker", "trial"):
        if given[name] is not None and not (given[name].strip() and given[name].isprintable()):
            wrong.append(f"--{name}: found {given[name]!r}, expected a name")
    picture = given["picture"] or out.with_name(f"{out.stem}.import.svg")
    if picture.suffix.lower() not in (".svg", ".png"):
        wrong.append(f"--picture: found the ending {picture.suffix!r}, expected .svg or .png")
    if wrong:
        raise ValueError("\n".join(wrong))
    options = {name: given[name] for name in ("up", "columns", "sides", "worker", "trial", "names_as")}
    options |= {"unit_m": unit_m, "rate_hz": rate_hz, "min_score": min_score}
    options |= {name: None if given[name] is None else Path(given[name]) for name in ("mapping_file", "asf")}
    return ImportAsked(options, picture, given["source"], given["licence"])


def _wrong_files(files: Sequence[str], out: Path, given: dict[str, Any]) -> list[str]:
    from opsim.cli.motion.files import of_another_kind, overwritten

    if out.suffix.lower() != ".npz":
        return [f"{out}: found the ending {out.suffix!r}, but a recording ends in .npz"]
    wrong = overwritten(out, recording=files) or of_another_kind(out, "recording")
    wrong += overwritten(given["picture"], recording=files) + _twice(files)
    wrong += [
        f"{each}: found a folder, expected the name of a file to write"
        for each in (out, given["picture"])
        if each is not None and "\0" not in str(each) and each.is_dir()
    ]
    for name, option in (("mapping_file", "--map"), ("asf", "--asf")):
        if given[name] is not None and ("\0" in given[name] or not Path(given[name]).is_file()):
            wrong.append(f"{option}: {given[name]!r}: no such file")
    return wrong


def _twice(files: Sequence[str]) -> list[str]:
    """Files that are given more than once, by whatever path."""
    places: dict[str, list[int]] = {}
    for place, file in enumerate(files, 1):
        places.setdefault(file if "\0" in file else os.path.realpath(file), []).append(place)
    return [
        f"{files[at[0] - 1]}: found as file {' and '.join(map(str, at))}, expected each file once"
        for at in places.values()
        if len(at) > 1
    ]


def _unit(text: str | None) -> tuple[float | None, list[str]]:
    """Metres of one unit by its name, or as a number."""
    from emulator.recordings.orientation import UNITS_M

    if text is None or text.lower() in UNITS_M:
        return (None if text is None else UNITS_M[text.lower()]), []
    number = _float(text)
    if 1e-6 <= number <= 1e3:
        return number, []
    return None, [f"--unit: found {text!r}, expected {', '.join(UNITS_M)}, or metres of one unit such as 0.01"]


def _number(option: str, text: str | None, least: float, most: float, what: str) -> tuple[float | None, list[str]]:
    if text is None or least <= (number := _float(text)) <= most:
        return (None if text is None else number), []
    return None, [f"{option}: found {text!r}, expected {what} from {least:g} to {most:g}"]


def _float(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        return math.nan


def _one_of(option: str, text: str | None, known: Sequence[str]) -> list[str]:
    return [] if text is None or text in known else [f"{option}: found {text!r}, expected {', '.join(known)}"]

"""``opsim motion clean``: what is wrong with a recording found, mended where it can be, and shown."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Any

import click

from opsim.cli.motion_clean_told import COLUMNS, cells, notes_of, tell, verdicts_of
from opsim.cli.verbs import Mistake, mistakes


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
    from opsim.cli.motion_files import no_empty_folders, ready

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
    from opsim.cli.motion_files import of_another_kind, overwritten

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

    from opsim.report.cleaned import headline

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
    from opsim.cli.stopping import stopped, stops_once, written_so_far

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
    from opsim.whole import whole_file

    with whole_file(repairs) as temporary, temporary.open("w", newline="", encoding="utf-8") as stream:
        table = csv.writer(stream)
        table.writerow(["take", "verdict", *COLUMNS])
        table.writerows([r.take, done.verdict(r.take), *cells(r)] for r in done.repairs)


def _draw(done: Any, file: str, pictures: list[Path]) -> None:
    from opsim.cli.motion_clean_view import view_of
    from opsim.cli.progress import progress
    from opsim.report.cleaned_picture import write_cleaned

    if not pictures:
        return
    with progress("draw") as report:
        report(0, 1)
        write_cleaned(view_of(done, f"{Path(file).stem}: {verdicts_of(done)}", notes_of(done)), *pictures)
        report(1, 1)

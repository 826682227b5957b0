"""Every raw file imported and drawn; unit, upward axis and sides found from the body in every recording."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

RAW = {
    "bandai_raise_up_right_hand_normal_001.bvh": {},
    "HDM_bd_depositFloorR_001_120.amc": {"names_as": "HDM_{worker}_*_{trial}_*"},
    "uiprmd_vicon_m05_s01_e02_positions.csv": {"columns": "plug-in-gait", "rate_hz": 100.0},
}


def evidence(motion: Path, out: Path) -> Iterator[tuple[str, str, bool]]:
    """(claim, what was found, whether it holds); a picture of each file in ``out``."""
    for name, options in RAW.items():
        yield _imported(motion / "raw" / name, out, options)
    yield _markers(motion)
    yield _amc(motion)
    yield from _all_recordings(motion)


def _imported(path: Path, out: Path, options: dict[str, Any]) -> tuple[str, str, bool]:
    """As ``opsim motion import`` does it, by its own functions."""
    from emulator.recordings.importing import imported, together
    from emulator.recordings.npz import read_recording
    from opsim.cli.motion.import_files import _write

    found = list(imported(path, **options))
    file = out / f"{path.stem}.npz"
    _write(found, together(found), file, file.with_suffix(".svg"))
    take, again = found[0].take, read_recording(file).takes[0]
    file.unlink()
    same = np.array_equal(take.positions_m, again.positions_m, equal_nan=True) and take.name == again.name
    said = f"{take.n_frames} frames at {take.rate_hz:g} Hz, {len(take.names)} joints, sides {found[0].sides.verdict}"
    tall_m = float(np.nanmax(take.positions_m[..., 2]))
    holds = same and found[0].sides.verdict == "as named" and 1.2 < tall_m < 2.4 and not found[0].mapping.of("unknown")
    return f"{path.name} is imported, drawn, written and read again", f"{said}, highest {tall_m:.2f} m", bool(holds)


def _markers(motion: Path) -> tuple[str, str, bool]:
    from emulator.recordings.importing import read_take
    from emulator.recordings.mapping import mapped

    path = motion / "raw" / "uiprmd_vicon_m05_s01_e02_positions.csv"
    take, _ = mapped(read_take(path, columns="plug-in-gait", rate_hz=100.0))
    return _alike("the 39 markers", take, _take(motion / "uiprmd_sit_to_stand.npz", "s01/e02"))


def _amc(motion: Path) -> tuple[str, str, bool]:
    from emulator.recordings.importing import read_take
    from emulator.recordings.mapping import mapped

    take, _ = mapped(read_take(motion / "raw" / "HDM_bd_depositFloorR_001_120.amc"))
    return _alike("the AMC", take, _take(motion / "hdm05_deposit_floor.npz", "bd/001"))


def _alike(what: str, take: Any, known: Any) -> tuple[str, str, bool]:
    """Against a known take, which has every second frame."""
    at = [take.names.index(name) for name in known.names]
    apart_mm = 1000 * np.linalg.norm(take.positions_m[::2][: known.n_frames, at] - known.positions_m, axis=-1).max()
    claim = f"joints of {what} are those of the shared recording, but for its rounding to 0.1 mm"
    return claim, f"at most {apart_mm:.3f} mm apart", bool(apart_mm < 0.1)


def _take(path: Path, name: str) -> Any:
    from emulator.recordings.npz import read_recording

    return next(take for take in read_recording(path).takes if take.name == name)


def _all_recordings(motion: Path) -> Iterator[tuple[str, str, bool]]:
    from emulator.recordings.npz import read_recording
    from emulator.recordings.orientation import UNITS_M, found_unit_m, found_up, turned_up
    from emulator.recordings.plausibility import checked_sides, mirrored, swapped_names

    units = placed = accused = found = n = 0
    for path in sorted(motion.glob("*.npz")):
        for take in read_recording(path).takes:
            n += 1
            lain = turned_up(take.positions_m, "-y")
            units += sum(found_unit_m(lain / unit_m, take.names)[0] == unit_m for unit_m in UNITS_M.values())
            placed += found_up(lain, take.names)[0] == "y"
            accused += checked_sides(take)[1].verdict != "as named"
            found += sum(checked_sides(wrong(take))[1].verdict == "swapped" for wrong in (swapped_names, mirrored))
    yield f"the unit is found from the body, {n} takes in {len(UNITS_M)} units", f"{units}", units == n * len(UNITS_M)
    yield "the upward axis is found from the body in every take", f"{placed} of {n}", placed == n
    yield "no true take is accused of exchanged sides", f"{accused} of {n}", accused == 0
    yield "exchanged names and mirrored axes are found in every take", f"{found} of {2 * n}", found == 2 * n

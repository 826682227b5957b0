"""BVH and ASF/AMC: files of producers read, drawn with their bones, written as BVH and read again."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from emulator.motion import Motion
from emulator.recordings import read_motions
from emulator.recordings.amc import read_amc
from emulator.recordings.bvh import read_bvh, read_bvh_file
from emulator.recordings.bvh_write import write_bvh, write_bvh_file
from emulator.recordings.take import Take
from emulator.skeleton import canonical_name

BVH, AMC = "bandai_raise_up_right_hand_normal_001.bvh", "HDM_bd_depositFloorR_001_120.amc"
KNOWN = "hdm05_deposit_floor.npz"
SETS = ("uiprmd_deep_squat", "uiprmd_side_lunge", "hdm05_squat_once", "hdm05_throw_ball", "bandai2_walk")
EACH = 12
BOUND_M = 1e-6
MOMENTS = 7
Line = tuple[str, str, bool]


@dataclass(frozen=True, eq=False)
class Again:
    """A take, and its joints after it was written as BVH and read again, both (T, J, 3)."""

    take: Take
    positions_m: np.ndarray

    @property
    def error_m(self) -> np.ndarray:
        """(T,) of the joint that is furthest off."""
        return np.linalg.norm(self.positions_m - self.take.positions_m, axis=2).max(axis=1)


def evidence(motion: Path, out: Path) -> Iterator[Line]:
    """(claim, what was found, whether it holds), with pictures written into ``out``."""
    bvh, amc = read_bvh(motion / "raw" / BVH), read_amc(motion / "raw" / AMC)
    for take in (bvh, amc):
        again = _again(take, out)
        _draw(again, out / f"{take.trial}.png")
        yield f"{take.trial}: is read, finite, in metres with z up", _said(take), _stands(take)
        yield _returns(f"{take.trial}: written as BVH and read again", again.error_m.max())
        spread = float(np.ptp(bones_m(take.parents, again.positions_m), axis=0).max())
        rigid = take is amc
        claim = "bones are as long in every frame" if rigid else "bones (but the way from the floor to the hips) are"
        yield f"{take.trial}, read again: {claim}", *_constant(take, again.positions_m, rigid, spread)
    yield _is_known(amc, motion / KNOWN)
    yield _to_the_bit(motion / "raw" / BVH, out)
    for name in SETS:
        motions = read_motions(motion / f"{name}.npz", None).motions[:EACH]
        yield _returns(f"{name}: {len(motions)} repetitions written as BVH and read again", _worst(motions, out))


def bones_m(parents: tuple[int, ...], positions_m: np.ndarray) -> np.ndarray:
    """Length (T, B) of each bone, in joint order."""
    children = [joint for joint, parent in enumerate(parents) if parent >= 0]
    return np.linalg.norm(positions_m[:, children] - positions_m[:, [parents[j] for j in children]], axis=2)


def _again(motion: Take | Motion, out: Path) -> Again:
    take = motion
    if isinstance(take, Motion):
        take = Take(take.skeleton.names, take.skeleton.parents, take.positions_m(world=True), 50.0, trial=take.trial)
    path = out / f"{take.trial}.bvh"
    write_bvh(motion, path)
    read = read_bvh(path)
    path.unlink()
    return Again(take, read.positions_m[:, [read.names.index(name) for name in take.names]])


def _worst(motions: tuple[Motion, ...], out: Path) -> float:
    return max(float(_again(motion, out).error_m.max()) for motion in motions)


def _returns(claim: str, error_m: float) -> Line:
    return f"{claim}: joints return to {BOUND_M:g} m", f"at most {error_m:.1e} m off", bool(error_m < BOUND_M)


def _said(take: Take) -> str:
    return f"{take.n_frames} frames at {take.rate_hz:g}/s, {len(take.names)} joints; {'; '.join(take.notes)}"


def _stands(take: Take) -> bool:
    """Everything is between the floor and a raised hand."""
    height = take.positions_m[..., 2]
    return bool(np.all(np.isfinite(take.positions_m)) and height.min() > -0.1 and 1.2 < height.max() < 2.6)


def _constant(take: Take, positions_m: np.ndarray, rigid: bool, spread: float) -> tuple[str, bool]:
    """Acclaim guarantees bones; each joint of the Bandai file could change its own, and only the root's way does."""
    if rigid:
        return f"to {spread:.1e} m", spread < BOUND_M
    lengths = np.ptp(bones_m(take.parents, positions_m), axis=0)
    others = float(max(v for name, v in zip(take.names[1:], lengths) if name != "Hips"))
    return f"to {others:.1e} m, the digits of the file; that way changes by {spread:.1e} m", others < 2 * BOUND_M


def _is_known(take: Take, path: Path) -> Line:
    with np.load(path) as known:
        wanted = known["positions"][: known["offsets"][1]]
    off = float(np.abs(take.positions_m[::2] - wanted).max())
    return f"{take.trial}: every second frame is what {path.name} holds", f"to {1e3 * off:.3f} mm", off < 1e-4


def _to_the_bit(path: Path, out: Path) -> Line:
    file = read_bvh_file(path)
    write_bvh_file(file, out / "same.bvh")
    again = read_bvh_file(out / "same.bvh")
    (out / "same.bvh").unlink()
    same = (file.names, file.parents, file.channels) == (again.names, again.parents, again.channels)
    equal = np.array_equal(file.values, again.values) and np.array_equal(file.offsets, again.offsets)
    found = f"{file.values.size:,} values, {'all equal' if equal else 'not all equal'}"
    return f"{path.stem}: the file itself comes back to the bit", found, bool(same and equal)


def _draw(again: Again, path: Path) -> None:
    """Moments as read and as read again, one over the other; bones with their range; the error along time."""
    from matplotlib.figure import Figure

    from opsim.report.plot.plotly import INK, MUTED

    n_bones = len(again.take.names) - 1
    figure = Figure(figsize=(12, 4.2 + 0.17 * n_bones), facecolor="white", layout="constrained")
    above, below = figure.subfigures(2, 1, height_ratios=(3.4, 0.8 + 0.17 * n_bones))
    axes = above.subplots()
    _moments(axes, again)
    title = f"{again.take.trial}: as read (grey) and written as BVH, read again (left blue, right orange)"
    axes.set_title(title, loc="left", color=INK, size=12, parse_math=False)
    bones, error = below.subplots(1, 2)
    _bones(bones, again)
    seconds = np.arange(again.take.n_frames) / again.take.rate_hz
    error.semilogy(seconds, np.maximum(again.error_m, 1e-12), color=INK, lw=1.2)
    error.axhline(BOUND_M, color="#D55E00", lw=1.2)
    error.text(seconds[-1], BOUND_M * 1.2, "bound", color="#D55E00", ha="right", size=9)
    error.set(xlabel="s", ylim=(1e-11, 1e-5), xlim=(0, seconds[-1]))
    error.set_title("furthest joint from where it was, m", loc="left", size=10, color=INK)
    for each in (bones, error):
        each.tick_params(labelcolor=MUTED, labelsize=8)
        each.spines[["top", "right"]].set_visible(False)
    figure.savefig(path, dpi=110, metadata={"Software": "opsim"})


def _moments(axes: Any, again: Again) -> None:
    from opsim.report.plot.body import LEFT, RIGHT, TRUNK

    take = again.take
    colour = {"left": LEFT, "right": RIGHT, "": TRUNK}
    step_m = 1.15
    for place, frame in enumerate(np.linspace(0, take.n_frames - 1, MOMENTS).astype(int)):
        for positions, style in ((take.positions_m, {"lw": 6, "color": "#d9dde2"}), (again.positions_m, {"lw": 1.6})):
            flat = positions[frame][:, [1, 2]] - [np.median(take.positions_m[frame, :, 1]), 0]
            for joint, parent in enumerate(take.parents):
                if parent >= 0 and take.names[parent] != "joint_Root":
                    line = flat[[parent, joint]] + [place * step_m, 0]
                    own = {"color": colour[_side(take.names[joint])]} | style
                    axes.plot(line[:, 0], line[:, 1], solid_capstyle="round", **own)
        axes.text(place * step_m, -0.06, f"{frame / take.rate_hz:.2f} s", ha="center", va="top", size=9)
    axes.axhline(0, color="#aab0b8", lw=1, zorder=0)
    axes.set(aspect="equal", xlim=(-0.7, (MOMENTS - 1) * step_m + 0.7))
    axes.axis("off")


def _side(name: str) -> str:
    try:
        side = canonical_name(name).partition("_")[0]
    except ValueError:
        return ""
    return side if side in ("left", "right") else ""


def _bones(axes: Any, again: Again) -> None:
    """A bar a bone, and how much it changes."""
    from opsim.report.plot.plotly import INK, MUTED

    take = again.take
    length = bones_m(take.parents, again.positions_m)
    names = [name for name, parent in zip(take.names, take.parents) if parent >= 0]
    at = np.arange(len(names))[::-1]
    axes.barh(at, 100 * np.median(length, axis=0), color="#9db8d2", height=0.72)
    for y, column in zip(at, length.T):
        change_m = np.ptp(column)
        said = f" {100 * np.median(column):.2f}" + (
            f"  changes by {1e3 * change_m:.2g} mm" if change_m > BOUND_M else ""
        )
        axes.text(100 * np.median(column), y, said, va="center", size=7.5, color=MUTED)
    axes.set(yticks=at, xlim=(0, 145 * np.median(length, axis=0).max()), ylim=(-0.7, len(names) - 0.3))
    axes.set_yticklabels(names, size=8)
    axes.set_title(
        "bones as read again, cm (constant to 1 µm unless said)",
        loc="left",
        size=10,
        color=INK,
    )

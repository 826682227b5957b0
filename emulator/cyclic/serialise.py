"""Switching dynamics as a library keeps them: the tables a step reads, without the support of the recordings.

A cyclic emulator bounds its draws beat by beat (``guide.py``), so that no step has to look through all recorded frames.

A CyclicEmulator as plain values and arrays for a library, and the way back, every part of it doubted.

Arrays are kept in single precision; a fit is rounded to it at once (``rounded``), so that what is loaded is what was
fitted, to the bit.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields, replace
from typing import Any

import numpy as np

from emulator.cyclic.latent import Finer, PoseLatent
from emulator.cyclic.model import CyclicEmulator
from emulator.cyclic.pace import Pace
from emulator.cyclic.report import CyclicReport
from emulator.cyclic.switching_dynamics import SwitchingDynamics
from emulator.cyclic.units import Crew, Guide, Unit
from emulator.skeleton import Skeleton
from emulator.stored import StoredArrays, packed

FAR = 1e30
"""Distance, or its square, that nothing has."""
COUNTED = ("used", "border_used")
KEPT = ("points", "per_length", *COUNTED[:1], "variance", "noise", "weight", "scale", "keep")
BORDERS = ("border_points", "border_per_length", COUNTED[1], "border_weight")
MOST_POINTS = 2000
DYNAMICS = {
    "points": ("S", "N", "I"), "per_length": ("S", "I"), "used": ("S",), "variance": ("S",), "noise": ("S",),
    "weight": ("S", "N", "D"), "scale": ("S", "D"), "keep": ("S",), "border_points": ("B", "M", "I"),
    "border_per_length": ("B", "I"), "border_used": ("B",), "border_weight": ("B", "M"), "states": ("S",),
    "shrink": ("S", "half"),
}  # fmt: skip
"""S states with N points of I inputs each, of which D are latents; B borders between states."""


def unbounded(dynamics: SwitchingDynamics) -> SwitchingDynamics:
    """The same processes; a step may go anywhere."""
    return replace(dynamics, tables=dynamics.tables | _nowhere(dynamics.n_latents))


def _nowhere(d: int) -> dict[str, np.ndarray]:
    """Tables of a support of one point that holds everything."""
    one = np.zeros((1, d))
    return {"support": one, "ways": one, "leading": np.array(1), "reach": np.array(FAR), "radius2": np.array(FAR)}


def dynamics_arrays(dynamics: SwitchingDynamics) -> dict[str, np.ndarray]:
    """What a library keeps; of the symmetric shrinkage the lower triangle."""
    tables = dynamics.tables
    rows, columns = np.tril_indices(tables["points"].shape[1])
    arrays = {name: tables[name] for name in (*KEPT, *BORDERS)}
    counts = {name: tables[name].astype(np.int32) for name in COUNTED}
    return arrays | counts | {"shrink": tables["shrink"][:, rows, columns], "states": dynamics.states.astype(np.int32)}


def dynamics_of(task: str, arrays: Mapping[str, np.ndarray]) -> SwitchingDynamics:
    """The way back. Raises ValueError for tables that do not fit each other: compiled code reads them unchecked."""
    n_states, n_points, n_inputs = _shape(task, arrays["points"], 3)
    d = _shape(task, arrays["weight"], 3)[2]
    n_borders, n_border_points, _ = _shape(task, arrays["border_points"], 3)
    if not (1 <= n_states <= 16 and 1 <= n_points <= MOST_POINTS and 1 <= d <= n_inputs and n_borders <= 16):
        raise ValueError(f"{task}: dynamics of {n_states} states, {n_points} points and {d} latents make no sense")
    StoredArrays(task, arrays, {"half": n_points * (n_points + 1) // 2}).record(DYNAMICS, "")
    _counted(task, arrays, "used", n_points)
    _counted(task, arrays, "border_used", n_border_points)
    if n_borders != (n_states if n_states > 2 else n_states - 1):
        raise ValueError(f"{task}: {n_borders} borders between {n_states} states")
    if any(np.any(arrays[name] < 0) for name in ("variance", "noise", "scale")):
        raise ValueError(f"{task}: a variance of its dynamics is negative")
    tables = {name: np.ascontiguousarray(arrays[name]) for name in (*KEPT, *BORDERS)}
    tables |= {name: arrays[name].astype(np.int64) for name in COUNTED}
    return SwitchingDynamics(
        arrays["states"].astype(int),
        tables | {"shrink": _square(arrays["shrink"], n_points)} | _nowhere(d),
        np.zeros((0, d)),
        FAR,
    )


def _square(lower: np.ndarray, n: int) -> np.ndarray:
    rows, columns = np.tril_indices(n)
    whole = np.zeros((len(lower), n, n))
    whole[:, rows, columns] = lower
    whole[:, columns, rows] = lower
    return whole


def _shape(task: str, array: np.ndarray, n_axes: int) -> tuple[int, ...]:
    if array.ndim != n_axes:
        raise ValueError(f"{task}: dynamics with an array of shape {array.shape}, expected {n_axes} axes")
    return array.shape


def _counted(task: str, arrays: Mapping[str, np.ndarray], name: str, most: int) -> None:
    found = arrays[name]
    if found.dtype.kind not in "iu" or np.any((found < 1) | (found > most)):
        raise ValueError(f"{task}/dynamics_{name}: found {found.tolist()}, expected whole numbers from 1 to {most}")


KIND = "cyclic"
UNITS = ("starts", "stops", "entries")
LATENT = {"mean": ("P",), "basis": ("P", "D"), "energy": ("E",)}
GUIDE = {"anchors": ("F", 3, "D"), "log_frames": (2,), "low": ("M",), "high": ("M",)}
FINER = {"points": ("N", "I"), "length": ("I",), "weight": ("N", "O"), "mean": ("O",)}
"""Arrays of each record: D components of P numbers of a pose, of which M are moved by the dynamics of I inputs."""
MOST_COMPONENTS, MOST_FRAMES = 200, 100_000


def pack(model: CyclicEmulator) -> tuple[dict[str, Any], dict[str, np.ndarray]]:
    """JSON values of a model for the header, and its arrays by name."""
    plain: dict[str, Any] = {
        "kind": KIND,
        "skeleton": {"names": list(model.skeleton.names), "parents": list(model.skeleton.parents)},
        "rate_hz": model.rate_hz,
        "pace": model.pace.as_dict(),
        "workers": list(model.crew.names),
        "log_step": [float(value) for value in model.crew.log_step],
        "control": [model.control_at, model.control_by],
        "floor": [model.ankle_legs, model.toe_legs],
        "temper": model.temper,
        "order": model.order,
        "contact_states": model.contact_states,
        "beat_frames": list(model.beat_frames),
        "guide": [model.guide.spread, model.guide.apart],
        "latent_scale": model.latent.scale,
        "report": model.report.as_dict(),
    }
    arrays = packed(model.latent, LATENT, "latent_")
    arrays |= {f"dynamics_{name}": array for name, array in dynamics_arrays(model.dynamics).items()}
    arrays |= packed(model.finer, FINER, "finer_")
    arrays |= packed(model.guide, GUIDE, "guide_")
    arrays |= {"offsets": model.crew.offsets, "bone_length_m": model.crew.bone_length_m}
    for name in UNITS:
        plain[name], arrays[f"{name}_z"], arrays[f"{name}_contact"] = _units(getattr(model, name))
    return plain, {name: a.astype(np.float32) if a.dtype.kind == "f" else a for name, a in arrays.items()}


def _units(units: tuple[Unit, ...]) -> tuple[list[list[float]], np.ndarray, np.ndarray]:
    """Rows (frames, control, foot), and the latents and contacts of all units one after the other."""
    rows = [[len(unit.z), unit.control, unit.foot] for unit in units]
    if not units:
        return rows, np.zeros((0, 1)), np.zeros((0, 2), np.uint8)
    return rows, np.concatenate([u.z for u in units]), np.concatenate([u.contact for u in units]).astype(np.uint8)


def rounded(model: CyclicEmulator) -> CyclicEmulator:
    """The model as a library would give it back; what its fit was made of stays with it."""
    plain, arrays = pack(model)
    back = unpack(model.task, plain, {f"{model.task}/{name}": array for name, array in arrays.items()})
    return replace(back, dynamics=replace(back.dynamics, fitted=model.dynamics.fitted))


def unpack(task: str, plain: Mapping[str, Any], arrays: Mapping[str, np.ndarray]) -> CyclicEmulator:
    """The model; ``arrays`` are named task/name. Raises KeyError, TypeError or ValueError for what is no model."""
    skeleton = Skeleton(tuple(plain["skeleton"]["names"]), tuple(plain["skeleton"]["parents"]))
    names = tuple(str(name) for name in plain["workers"])
    own = StoredArrays.of(task, arrays, P=3 * skeleton.n_bones + 4, B=skeleton.n_bones, W=len(names))
    wide = {name: array.astype(float) if array.dtype.kind == "f" else array for name, array in own.arrays.items()}
    n = wide["latent_basis"].shape[-1]
    own = replace(own, arrays=wide).knowing(D=n)
    if not 1 <= n <= MOST_COMPONENTS:
        raise ValueError(f"{task}: {n} components make no sense")
    scale = own.positive("latent_scale", plain["latent_scale"])
    latent = PoseLatent(**own.record(LATENT, "latent_"), scale=scale)
    heads = {name.removeprefix("dynamics_"): a for name, a in wide.items() if name.startswith("dynamics_")}
    dynamics = dynamics_of(task, heads)
    order = int(plain["order"])
    if order not in (1, 2) or dynamics.n_latents % order:
        raise ValueError(f"{task}: dynamics of order {order} make no sense")
    moved = dynamics.n_latents // order
    inputs = moved + dynamics.n_controls
    if not (moved <= n and dynamics.n_controls in (0, 1)):
        raise ValueError(f"{task}: dynamics of {moved} latents and {dynamics.n_controls} inputs for {n} components")
    log_step = np.array([own.number("log_step", value) for value in plain["log_step"]])
    bones = own.array("bone_length_m", "W", "B")
    if not names or len(log_step) != len(names) or np.any(bones <= 0):
        raise ValueError(f"{task}: its workers make no sense")
    pace = pace_of(own, plain["pace"])
    control, floor = ([own.number(name, value) for value in plain[name]] for name in ("control", "floor"))
    low, usual = (int(value) for value in plain["beat_frames"])
    if not (len(control) == len(floor) == 2 and control[1] > 0 and 0 < low <= usual < MOST_FRAMES):
        raise ValueError(f"{task}: its control, floor or beats make no sense")
    units = {name: _units_of(own, plain[name], name, pace.steps) for name in UNITS}
    if not units["entries"]:
        raise ValueError(f"{task}: it has no recorded beat")
    if pace.steps and [len(units[k]) > 0 for k in ("starts", "stops")] != [pace.start_beats > 0, pace.stop_beats > 0]:
        raise ValueError(f"{task}: its starts and stops do not fit the time that starting and stopping take")
    return CyclicEmulator(
        task=task,
        skeleton=skeleton,
        rate_hz=own.positive("rate_hz", plain["rate_hz"]),
        latent=latent,
        dynamics=dynamics,
        finer=_finer(own, inputs, n - moved),
        temper=own.positive("temper", plain["temper"]),
        order=order,
        **units,
        guide=_guide(own, plain["guide"], moved, 2 if pace.steps else 1),
        pace=pace,
        crew=Crew(names, own.array("offsets", "W", "D"), log_step, bones),
        control_at=control[0],
        control_by=control[1],
        ankle_legs=floor[0],
        toe_legs=floor[1],
        contact_states=bool(plain["contact_states"]),
        beat_frames=(low, usual),
        report=CyclicReport.of_dict(plain["report"]),
    )


def pace_of(own: StoredArrays, plain: Mapping[str, Any]) -> Pace:
    """Every number finite, and those that must be positive so."""
    values = {one.name: plain[one.name] for one in fields(Pace)}
    steps = values.pop("steps")
    numbers = {name: own.number(name, value) for name, value in values.items()}
    within = all(numbers[name] >= 0 for name in ("time_cv", "length_cv", "start_beats", "stop_beats"))
    within = within and numbers["first"] > 0 and numbers["default"] > 0 and abs(numbers["follows"]) < 1
    if not within or not isinstance(steps, bool) or max(abs(numbers[k]) for k in ("intercept", "usual", "slope")) > 20:
        raise ValueError(f"{own.task}: its pace makes no sense")
    return Pace(steps=steps, **numbers)


def _finer(own: StoredArrays, inputs: int, outputs: int) -> Finer:
    sizes = own.knowing(I=inputs, O=outputs)
    found = Finer(**sizes.record(FINER, "finer_"))
    if np.any(found.length <= 0):
        raise ValueError(f"{own.task}/finer_length: found a length that is not positive")
    return found


def _guide(own: StoredArrays, plain: Any, moved: int, feet: int) -> Guide:
    spread, apart = (own.number("guide", value) for value in plain)
    found = own.knowing(M=moved).record(GUIDE, "guide_")
    if not 1 <= len(found["anchors"]) <= feet:
        raise ValueError(f"{own.task}: found anchors of {len(found['anchors'])} feet")
    if not 0 < np.exp(np.abs(found["log_frames"]) @ np.array([1.0, 4.0])) < MOST_FRAMES:
        raise ValueError(f"{own.task}: the frames of its beats make no sense")
    return Guide(**found, spread=spread, apart=apart)


def _units_of(own: StoredArrays, rows: Any, name: str, steps: bool) -> tuple[Unit, ...]:
    frames = [int(row[0]) for row in rows]
    if any(not 2 <= count < MOST_FRAMES for count in frames):
        raise ValueError(f"{own.task}: {name} of {frames} frames make no sense")
    z = own.array(f"{name}_z", sum(frames), "D" if rows else -1)
    contact = own.array(f"{name}_contact", sum(frames), 2).astype(bool)
    ends = np.cumsum([0, *frames])
    units = []
    for row, start, stop in zip(rows, ends[:-1], ends[1:]):
        foot = int(row[2])
        if foot not in ((0, 1) if steps else (-1,)):
            raise ValueError(f"{own.task}: {name} of a foot {foot}")
        units.append(Unit(z[start:stop], contact[start:stop], own.number(name, row[1]), foot))
    return tuple(units)

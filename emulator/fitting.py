"""The way from recordings to a MotionEmulator, step by step; each step's own file knows its mathematics."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
from threadpoolctl import threadpool_limits

from emulator.align import align, resample
from emulator.fit_judge import novelty_ratio, reconstruction_deg, roughness_ratio
from emulator.fit_report import FitReport
from emulator.flatten import SIEM
from emulator.joint import JointScale
from emulator.margin import Margin, fit_margin, within_worker
from emulator.marks import clock_to_coordinates
from emulator.model import SCHEME, MotionEmulator
from emulator.motion import Motion, MotionSet
from emulator.reduce import JointPCA
from emulator.root import RootChannel
from emulator.storage import on_grid
from emulator.warp import clr, from_clr
from emulator.workforce import BETWEEN_METHOD, Workforce, intraclass_correlation, shrinkages

ROOT_SHARE, PACE_SHARE, BONE_SHARE = 0.98, 0.98, 0.98
LARGEST_POSTURE = 24
DURATION_KNOTS, MARK_KNOTS = 12, 60
ROUGH = 1.5
LARGEST_ICC_FOR_SCORES = 0.3
ROUGH_NOTE = (
    "draws are much rougher than the recordings: too few repetitions for one Gaussian, or people that differ in kind "
    "(for example in the leading leg); look at them before use, draw known workers, or fit the kinds apart"
)
TWINS_NOTE = (
    "half of the repetitions or more are copies of another one, so novelty cannot be estimated and the draws vary too "
    "little; is one recording in the file several times?"
)
ALIKE_NOTE = (
    "all repetitions are one and the same movement: there is no variation to learn, and every draw is that movement; "
    "is one recording in the file several times?"
)
Progress = Callable[[int, int, str], None] | None


def fit(
    motions: MotionSet,
    scheme: str,
    n_components: int | float | None,
    n_times: int,
    n_knots: int,
    progress: Progress,
    seed: int,
    command: str,
) -> MotionEmulator:
    """See ``MotionEmulator.fit``."""
    _check(motions, scheme, n_times, n_knots)
    with threadpool_limits(1, user_api="blas"):  # one thread: the same recordings give the same bytes everywhere
        return _fit(motions, n_components, n_times, n_knots, progress, seed, command)


def _fit(
    motions: MotionSet,
    n_components: int | float | None,
    n_times: int,
    n_knots: int,
    progress: Progress,
    seed: int,
    command: str,
) -> MotionEmulator:
    warps = _smooth(_aligned_warps(motions, n_times, progress), n_knots)
    directions = np.stack([resample(m.directions, gamma) for m, gamma in zip(motions.motions, warps)])
    flatten = SIEM.fit(directions)
    posture = stored(JointPCA.fit(_flat(flatten.forward(directions)), n_components, _largest(n_components)))
    bones, log_bones = _bones(motions)
    channel = _channels(motions, warps, directions, np.exp(bones.inverse(bones.forward(log_bones))))
    root = stored(JointPCA.fit(channel, ROOT_SHARE, 8))
    pace = JointPCA.fit(clr(warps, n_knots), PACE_SHARE, 10)
    modelled = from_clr(pace.inverse(pace.forward(clr(warps, n_knots))), n_times)
    index, log_duration = motions.worker_index, np.log(motions.duration_s)
    icc = intraclass_correlation(log_duration, index)
    margin = _duration_margin(log_duration, index, icc[0])
    marks = clock_to_coordinates(_mark_clock(motions, modelled))
    mark_margins = tuple(fit_margin(column, column, MARK_KNOTS, 0.05) for column in marks.T)
    scale, z = JointScale.fit(
        {
            "posture": posture.forward(_flat(flatten.forward(directions))),
            "root": root.forward(channel),
            "pace": pace.forward(clr(warps, n_knots)),
            "duration": margin.forward(log_duration)[:, None],
            "marks": np.stack([m.forward(c) for m, c in zip(mark_margins, marks.T)], axis=1) if mark_margins else marks,
            "bones": bones.forward(log_bones),
        }
    )
    workforce = Workforce.fit(z, index, motions.workers, *shrinkages(len(z), len(motions.workers)))
    model = MotionEmulator(
        motions.task,
        motions.skeleton,
        motions.mark_names,
        n_times,
        flatten,
        posture,
        root,
        pace,
        bones,
        margin,
        mark_margins,
        scale,
        workforce,
        _report(
            motions,
            posture,
            scale,
            margin,
            mark_margins,
            icc,
            workforce,
            command,
        ),
    )
    return replace(model, report=_judged(model, directions, warps, z, seed))


def _duration_margin(log_duration: np.ndarray, worker_index: np.ndarray, icc: float) -> Margin:
    """Lognormal; normal scores where the residuals refuse it and workers hardly differ.

    Where a few people differ, pooled scores are steps at each of them, and a new worker between two has two modes;
    on held-out repetitions of such people the lognormal was as good or better (DESIGN.md).
    """
    residual = within_worker(log_duration, worker_index)
    return fit_margin(log_duration, residual[:0] if icc > LARGEST_ICC_FOR_SCORES else residual, DURATION_KNOTS)


def stored(pca: JointPCA) -> JointPCA:
    """The same components on the grid they are stored on, so that a saved model is the fitted one."""
    return JointPCA(on_grid(pca.mean[None])[0], on_grid(pca.basis), pca.explained_variance)


def _check(motions: MotionSet, scheme: str, n_times: int, n_knots: int) -> None:
    if scheme != SCHEME:
        raise ValueError(f"scheme: no {scheme!r}; known: {SCHEME}")
    if len(motions) < 3:
        raise ValueError(f"{motions.task}: a model needs at least 3 repetitions, found {len(motions)}")
    if n_times < 10 or not 2 <= n_knots < n_times:
        raise ValueError(f"n_times {n_times} must be 10 or more and n_knots {n_knots} from 2 to below it")


def _aligned_warps(motions: MotionSet, n_times: int, progress: Progress) -> np.ndarray:
    return align([m.directions for m in motions.motions], n_times=n_times, progress=progress).warps


def _smooth(warps: np.ndarray, n_knots: int) -> np.ndarray:
    """Warps (N, T) that the pace coordinates can say exactly: postures are aligned with these."""
    return from_clr(clr(warps, n_knots), warps.shape[1])


def _flat(tangent: np.ndarray) -> np.ndarray:
    return tangent.reshape(len(tangent), -1)


def _largest(n_components: int | float | None) -> int | None:
    return LARGEST_POSTURE if n_components is None else None


def _bones(motions: MotionSet) -> tuple[JointPCA, np.ndarray]:
    """Components of log bone lengths, and each repetition's (N, B): those of its worker, the mean over repetitions."""
    index = motions.worker_index
    log_bones = np.log(np.stack([m.bone_length_m for m in motions.motions]))
    log_bones = np.stack([log_bones[index == w].mean(axis=0) for w in range(len(motions.workers))])[index]
    return JointPCA.fit(log_bones, BONE_SHARE), log_bones


def _channels(motions: MotionSet, warps: np.ndarray, directions: np.ndarray, bone_length_m: np.ndarray) -> np.ndarray:
    """Side channels of the root on the common clock, (N, T * 4)."""
    channel = RootChannel(motions.skeleton)
    rows = []
    for motion, gamma, posture, bones in zip(motions.motions, warps, directions, bone_length_m):
        root, yaw = _on_clock(motion, gamma)
        rows.append(channel.forward(posture, bones, root, yaw).ravel())
    return np.stack(rows)


def _on_clock(motion: Motion, gamma: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Path (T, 3) and heading (T,) of a motion at the common clock's times."""
    at = gamma * motion.duration_s
    root = np.stack([np.interp(at, motion.time_s, motion.root_m[:, c]) for c in range(3)], axis=1)
    return root, np.interp(at, motion.time_s, motion.yaw_rad)


def _mark_clock(motions: MotionSet, warps: np.ndarray) -> np.ndarray:
    """When the marks came on the common clock, (N, E), by the warps that the model will draw."""
    clock = np.linspace(0, 1, warps.shape[1])
    share = motions.mark_s / motions.duration_s[:, None]
    return np.stack([np.interp(at, gamma, clock) for at, gamma in zip(share, warps)]).reshape(len(motions), -1)


def _report(
    motions: MotionSet,
    posture: JointPCA,
    scale: JointScale,
    margin: Margin,
    mark_margins: tuple[Margin, ...],
    icc: tuple[float, ...],
    workforce: Workforce,
    command: str,
) -> FitReport:
    duration_s = motions.duration_s
    nan = float("nan")
    return FitReport(
        task=motions.task,
        scheme=SCHEME,
        n_sequences=len(motions),
        n_workers=len(motions.workers),
        n_components=posture.n_components,
        n_coordinates=len(scale.centre),
        explained_variance=posture.explained_variance,
        duration_mean_s=float(duration_s.mean()),
        duration_cv=float(duration_s.std(ddof=1) / duration_s.mean()),
        duration_margin=f"log duration {margin.name}" if len(margin.z) > 1 else "lognormal",
        icc=icc[0],
        icc_low=icc[1],
        icc_high=icc[2],
        reconstruction_deg=nan,
        roughness_ratio=nan,
        novelty_ratio=nan,
        mark_names=tuple(motions.mark_names),
        source=motions.source,
        licence=motions.licence,
        where=motions.selection,
        command=command,
        methods={
            "registration": "S-TSRVF, dynamic programming, group template, warps centred",
            "pace": "centred log ratio of the warps, monotone cubic between knots, PCA",
            "density": f"Gaussian by its factor; within-worker correlations shrunk by rho {workforce.within.rho:.3f}",
            "workers": BETWEEN_METHOD.format(rho=f"{workforce.between.rho:.3f}"),
            "marks": "; ".join(f"{n}: {m.name}" for n, m in zip(motions.mark_names, mark_margins)),
            "icc": "Shrout & Fleiss ICC(1,1) of log duration, exact F interval, 95 %",
            "root": "rides on the feet; slip, clearance and heading modelled",
        },
        notes=tuple(motions.notes),
    )


def _judged(model: MotionEmulator, directions: np.ndarray, warps: np.ndarray, z: np.ndarray, seed: int) -> FitReport:
    drawn = model.sample(50, np.random.default_rng(seed))
    rough = roughness_ratio(model.flatten, drawn.directions(n_times=model.n_times), directions, warps)
    novelty, report = novelty_ratio(drawn.scores, z), model.report
    twins = (ALIKE_NOTE if model.posture.n_components == 0 else TWINS_NOTE,) if math.isnan(novelty) else ()
    return replace(
        report,
        reconstruction_deg=reconstruction_deg(model.flatten, directions, model.posture.n_components),
        roughness_ratio=rough,
        novelty_ratio=novelty,
        notes=report.notes + twins + ((ROUGH_NOTE,) if rough > ROUGH else ()),
    )

"""What the fit report says of the repetitions: what the posture components lose of them, and which are strangers.

What a fit says of itself: where the recordings come from, which methods were used, and how the draws compare.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from emulator.covariates.table import unused_columns
from emulator.fitting.noise import MOST_JERK, Noise
from emulator.fitting.registration import Registered
from emulator.fitting.report import FitReport, TimeFit
from emulator.fitting.settings import FitSettings
from emulator.fitting.steps import Parts
from emulator.geometry import sphere
from emulator.geometry.flattening import Flattening, resample
from emulator.judge.clips import Clips, frame_rate_hz
from emulator.judge.feet import footing
from emulator.judge.joint_speeds import peak_ratio, share_too_fast
from emulator.judge.posture_tests import disco, novelty, roughness
from emulator.judge.sequence_distances import distances, pooled
from emulator.model.dwell_fit import HOLDS_METHOD, said
from emulator.model.dwell_times import NONE
from emulator.model.emulator import MotionEmulator
from emulator.model.feet import fastest_m_per_s
from emulator.model.joint_coordinates import Margin
from emulator.model.performances import MotionPerformances
from emulator.model.reduction import JointPCA
from emulator.model.smoothed import BASE, MOST_NOISE_BESIDE
from emulator.motion import MotionSet
from emulator.people.variance_components import intraclass_correlation
from emulator.people.workers import BETWEEN_METHOD, Workforce

STRANGE, FEWEST_TO_JUDGE = 6.0, 6
"""Of 263 correct public repetitions one lies this many times as far from the nearest other as they usually do."""


def reconstruction_deg(flatten: Flattening, directions: np.ndarray, n_components: int, n_folds: int = 5) -> float:
    """Mean angle (degrees a bone) between aligned repetitions (N, T, B, 3) and their projection on others' components.

    Folds are every ``n_folds``-th repetition, so that in each some repetitions of every worker are left in.
    """
    flat = flatten.forward(directions).reshape(len(directions), -1)
    folds = np.arange(len(flat)) % min(n_folds, len(flat))
    angles = []
    for fold in np.unique(folds):
        held = folds == fold
        rank = int(np.sum(~held)) - 1
        if rank < 1:
            return float("nan")
        pca = JointPCA.fit(flat[~held], 0.999999, min(n_components, rank))
        again = flatten.inverse(
            pca.inverse(pca.forward(flat[held])).reshape(-1, directions.shape[1], flatten.n_channels)
        )
        angles.append(sphere.angle(again, directions[held]).mean(axis=(1, 2)))
    return float(np.degrees(np.concatenate(angles).mean()))


def strangers(left_out: np.ndarray, names: Sequence[str]) -> tuple[str, ...]:
    """A note on the repetitions that are like no other, by the distances (N, N) among all, infinite on the diagonal."""
    nearest = left_out.min(axis=1)
    usual = np.median(nearest)
    far = np.flatnonzero(nearest > STRANGE * usual)
    if len(names) < FEWEST_TO_JUDGE or usual <= 0 or len(far) == 0:
        return ()
    each = ", ".join(f"{names[i]} ({nearest[i] / usual:.0f} times as far as usual)" for i in far.tolist())
    return (f"far from every other repetition, another movement or a mistake: {each}",)


ROUGH, N_NEW, N_TIMES, N_PERMUTATIONS, MOST_TIMES, MOST_CLIPS = 1.5, 50, 25, 199, 101, 60
GAUSSIAN = "Gaussian by its factor; within-worker correlations shrunk by rho {rho}"
HELD = (
    "held near the identity with weight {:g}, the least at which recordings given each other's pace accelerate hardly "
    "more than they did"
)
ROOT = "a path of its own in leg lengths, and the heading; feet stand when and as those of the nearest recording did"
SMOOTHED = (
    "recordings blurred by smooth low-rank noise that makes a posture at most as far from the nearest recording as a "
    "left-out recording is, other coordinates by Silverman's rule; slopes of the pace within a fifth of the recorded "
    f"ones; a known worker from the worker's own repetitions, and with the weight of {BASE:g} repetitions from "
    "everybody's deviations about the worker's shrunk mean; a new worker near a recorded one, with smooth noise "
    "between people, of the size that a t gives to the next of so few"
)
STIFFNESS = (
    "noise {:g} times as smooth as what recordings of one worker differ by, at most {:.0f} % of the variance of "
    "postures and {:.0f} % of that of paths and paces{}: of those tried what goes farthest from the "
    "recordings while draws jerk no more than {:g} times as hard as they do and are as quick, or else the least far"
)
STIFFNESS_PEOPLE = ", that between people {:g} times as smooth as what they differ by"
POSTURE_SIZE = "all that say more than 0.1 degrees a bone"
ROUGH_NOTE = (
    "draws of new people are much rougher than the recordings: the people differ in kind (for example in the leading "
    "leg), and one between two kinds moves like neither; draw known workers, or fit the kinds apart"
)
TWINS_NOTE = (
    "half of the repetitions or more are copies of another one, so novelty cannot be estimated and the draws vary too "
    "little; is one recording in the file several times?"
)
ONCE_NOTE = (
    "one repetition of each worker: what changes from one to the next is not known, so a worker does the same every "
    "time, and all variation lies between workers"
)
ALONE_NOTE = (
    "one person: how people differ is not known, so there is no law between people, and every worker drawn moves as "
    "this one does"
)
KINDS_NOTE = (
    "the people do this on {} sides, as with the left or the right hand or foot ({}): a new worker does it on one of "
    "them, as often as these do"
)
UNUSED_NOTE = "columns that nothing here uses: {}; --covariate NAME explains by one how people differ"
ALIKE_NOTE = (
    "all repetitions are one and the same movement: there is no variation to learn, and every draw is that movement; "
    "is one recording in the file several times?"
)


def summary(
    made: Registered, parts: Parts, workforce: Workforce, settings: FitSettings, covariates: Sequence[str]
) -> FitReport:
    """The report before the draws are judged."""
    whole = made.whole
    duration_s, nan = whole.duration_s, float("nan")
    icc = intraclass_correlation(np.log(duration_s), whole.worker_index)
    return FitReport(
        task=whole.task,
        scheme=settings.scheme if workforce.smoothed else settings.scheme.replace("Smoothed", "MVG"),
        n_sequences=len(whole),
        n_workers=len(whole.workers),
        n_components=parts.posture.n_components,
        n_coordinates=len(parts.scale.centre),
        explained_variance=parts.posture.explained_variance,
        duration_mean_s=float(duration_s.mean()),
        duration_cv=float(duration_s.std(ddof=1) / duration_s.mean()),
        duration_margin=_margin_said(parts.margin),
        icc=icc[0],
        icc_low=icc[1],
        icc_high=icc[2],
        reconstruction_deg=nan,
        roughness_ratio=nan,
        novelty_ratio=nan,
        mark_names=tuple(whole.mark_names),
        source=whole.source,
        licence=whole.licence,
        where=whole.selection,
        command=settings.command,
        methods=_methods(made, parts, workforce, settings) | _told(covariates),
        notes=(
            *whole.notes,
            *said(parts.dwells, made.holds),
            *_once(whole),
            *_kinds(workforce),
            *_unused(whole, settings),
        ),
        fastest_m_per_s=float(fastest_m_per_s(made.moving.motions).max()),
    )


def _margin_said(margin: Margin) -> str:
    if len(margin.z) > 2:
        return f"log duration {margin.name}"
    return "lognormal" if len(margin.z) == 1 else f"lognormal, at least {np.exp(margin.value[1]):.3g} s"


def stiffness_said(own: Noise, between: float) -> str:
    """How smooth and large the noise is that blurs recordings, and how smooth that between people; 0: there is none."""
    (stiffness, most), people = own, STIFFNESS_PEOPLE.format(between) if between else ""
    return STIFFNESS.format(stiffness, 100 * most, 100 * MOST_NOISE_BESIDE, people, MOST_JERK)


def _once(whole: MotionSet) -> tuple[str, ...]:
    if len(whole.workers) == 1:
        return (ALONE_NOTE,)
    return (ONCE_NOTE,) if len(whole) == len(whole.workers) else ()


def _kinds(workforce: Workforce) -> tuple[str, ...]:
    names, kinds = np.array(workforce.names), workforce.kinds.of
    if not workforce.kinds.several:
        return ()
    sides = [", ".join(names[kinds == kind]) for kind in range(kinds.max() + 1)]
    return (KINDS_NOTE.format(len(sides), " | ".join(sides)),)


def _unused(whole: MotionSet, settings: FitSettings) -> tuple[str, ...]:
    names = unused_columns(whole, settings.covariates)
    return (UNUSED_NOTE.format(", ".join(names)),) if names else ()


def judged(model: MotionEmulator, made: Registered, settings: FitSettings) -> FitReport:
    """The report with the draws of the same people beside their recordings, and of new people for roughness."""
    rng = np.random.default_rng(settings.seed)
    alike = _alike(model, made, rng)
    many = _alike(model, made, rng, N_TIMES)
    new = model.sample(N_NEW, rng)
    own = np.stack([resample(m.directions, np.linspace(0, 1, model.n_times)) for m in made.moving.motions])
    rough, rough_new = (_over(_roughness(model, drawn), roughness(own)) for drawn in (alike, new))
    new_to_recorded, p, left_out = _postures(model.aligned_directions(alike.scores), made.directions, rng)
    twins = (ALIKE_NOTE if model.posture.n_components == 0 else TWINS_NOTE,) if math.isnan(new_to_recorded) else ()
    return replace(
        _in_real_time(model.report, alike, new, made),
        reconstruction_deg=reconstruction_deg(model.flatten, made.directions, model.posture.n_components),
        roughness_ratio=rough,
        roughness_new_ratio=rough_new,
        novelty_ratio=new_to_recorded,
        disco_p=p,
        times=_times(many, made),
        notes=model.report.notes
        + twins
        + strangers(left_out, [motion.name for motion in made.moving.motions])
        + ((ROUGH_NOTE,) if rough_new > ROUGH else ()),
    )


def _alike(model: MotionEmulator, made: Registered, rng: np.random.Generator, n_each: int = 1) -> MotionPerformances:
    """``n_each`` performances for each recording, by its worker."""
    index = made.moving.worker_index
    drawn = [
        model.sample(n_each * int(np.sum(index == w)), rng, worker=name).scores for w, name in enumerate(model.workers)
    ]
    return model.performances(np.concatenate(drawn))


def _roughness(model: MotionEmulator, drawn: MotionPerformances) -> float:
    """In own time, without pauses (a pause would look rough)."""
    moving = replace(model, dwells=NONE).performances(drawn.scores, drawn.body_scale, drawn.turns)
    return roughness(moving.directions(n_times=model.n_times))


def _over(emulated: float, recorded: float) -> float:
    return emulated / recorded if recorded > 1e-12 else float("nan")


def _postures(drawn: np.ndarray, recorded: np.ndarray, rng: np.random.Generator) -> tuple[float, float, np.ndarray]:
    """Novelty of drawn postures (n, T, B, 3) against left-out recordings (N, T, B, 3), DISCO's p, distances (N, N)."""
    step = -(-recorded.shape[1] // MOST_TIMES)
    drawn, recorded = drawn[:, ::step], recorded[:, ::step]
    among, across = distances(recorded), distances(drawn, recorded)
    left_out = among + np.diag(np.full(len(among), np.inf))
    left_out = np.where(left_out < 1e-5, 0.0, left_out)  # twins lie within the rounding of float32
    test = disco(pooled(across, distances(drawn), among), len(drawn), rng, N_PERMUTATIONS)
    return novelty(across, left_out), test.p, left_out


def _in_real_time(report: FitReport, alike: MotionPerformances, new: MotionPerformances, made: Registered) -> FitReport:
    """Speed, jerk and feet of at most ``MOST_CLIPS`` draws each, beside all recordings."""
    recorded, rate_hz = Clips.recorded(made.whole, alike.skeleton), frame_rate_hz(made.whole)
    some = np.unique(np.linspace(0, len(alike) - 1, MOST_CLIPS).astype(int))
    known, others = Clips.drawn(alike[some], rate_hz), Clips.drawn(new[:MOST_CLIPS], rate_hz)
    wander, recorded_wander = (_mean(footing(clips).wander_cm) for clips in (known, recorded[some]))
    return replace(
        report,
        too_fast=share_too_fast(known, recorded),
        too_fast_new=share_too_fast(others, recorded),
        jerk_ratio=peak_ratio(known, recorded, 3),
        jerk_new_ratio=peak_ratio(others, recorded, 3),
        wander_cm=wander,
        wander_recorded_cm=recorded_wander,
    )


def _mean(values: np.ndarray) -> float:
    known = values[np.isfinite(values)]
    return float(known.mean()) if len(known) else math.nan


def _times(drawn: MotionPerformances, made: Registered) -> tuple[TimeFit, ...]:
    emulated = [drawn.duration_s, *drawn.mark_s.T]
    recorded = [made.whole.duration_s, *made.whole.mark_s.T]
    return tuple(TimeFit.of(*row) for row in zip(("duration", *made.whole.mark_names), emulated, recorded))


def _methods(made: Registered, parts: Parts, workforce: Workforce, settings: FitSettings) -> dict[str, str]:
    methods = {
        "registration": "S-TSRVF, dynamic programming, group template, warps centred; " + HELD.format(made.penalty),
        "pace": "centred log ratio of the warps, a cubic spline of log slopes, PCA",
        "components": POSTURE_SIZE if settings.n_components is None else "as asked for",
        "density": GAUSSIAN.format(rho=f"{workforce.within.rho:.3f}") if workforce.smoothed is None else SMOOTHED,
        "workers": BETWEEN_METHOD.format(rho=f"{workforce.between.rho:.3f}"),
        "marks": "; ".join(f"{n}: {m.name}" for n, m in zip(made.whole.mark_names, parts.mark_margins)),
        "icc": "Shrout & Fleiss ICC(1,1) of log duration, 95 % interval of Thomas & Hultquist",
        "root": ROOT,
    }
    holds = {"holds": HOLDS_METHOD} if len(parts.dwells) else {}
    marks = {"landmarks": f"marks drawn together with strength {settings.landmarks:g}"} if settings.landmarks else {}
    return methods | holds | marks


def _told(covariates: Sequence[str]) -> dict[str, str]:
    return {"covariates": "; ".join(covariates)} if covariates else {}

"""The way from recordings to a MotionEmulator, step by step; each step's own file knows its mathematics."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from threadpoolctl import threadpool_limits

from emulator.covariates.table import asked_table
from emulator.fitting.noise import NOISES, naturally, with_population
from emulator.fitting.preprocessing import refuse_unsound
from emulator.fitting.registration import Registered, registered
from emulator.fitting.scheme_choice import choose
from emulator.fitting.settings import AUTO, FitSettings, Progress
from emulator.fitting.steps import Covariates, Parts, covariates_of, parts_of
from emulator.fitting.summary import judged, stiffness_said, summary
from emulator.model.emulator import MotionEmulator
from emulator.model.joint_coordinates import CURVES
from emulator.model.reduction import JointPCA
from emulator.model.smoothed import Curves, smoothed
from emulator.motion import MotionSet
from emulator.people.bone_turns import BoneTurns
from emulator.people.kinds import Kinds, kinds_of
from emulator.people.workers import Workforce, shrinkages

FEWEST = 3


def fit(motions: MotionSet, settings: FitSettings, progress: Progress = None) -> MotionEmulator:
    """See ``MotionEmulator.fit``."""
    if len(motions) < FEWEST:
        raise ValueError(f"{motions.task}: a model needs at least {FEWEST} repetitions, found {len(motions)}")
    refuse_unsound(motions)
    asked_table(motions, settings.covariates)  # its mistakes name the task and the repetition themselves
    with threadpool_limits(1, user_api="blas"):  # one thread: the same recordings give the same bytes everywhere
        try:
            return _fit(motions.in_order(), settings, progress)
        except ValueError as error:
            raise ValueError(f"{motions.task}: {error}") from error


def _fit(motions: MotionSet, settings: FitSettings, progress: Progress) -> MotionEmulator:
    made = registered(motions, settings, progress)
    said = ""
    if settings.scheme == AUTO:
        choice = choose(made, settings, model_of, progress)
        settings, said = replace(settings, scheme=choice.scheme), choice.why
    model = model_of(made, settings)
    if said:
        model = replace(model, report=replace(model.report, methods=model.report.methods | {"scheme": said}))
    return replace(model, report=judged(model, made, settings))


def model_of(made: Registered, settings: FitSettings) -> MotionEmulator:
    """The emulator of registered recordings, its report without a judgement of draws."""
    motions = made.whole
    parts = parts_of(made, settings)
    curves = _curves(parts)
    kinds = _kinds(parts, made.moving, settings)
    alike = replace(parts, z=parts.z - kinds.shift[made.moving.worker_index])
    covariates = covariates_of(alike, made.moving, settings.covariates)
    crew = _crew(parts, made.moving, covariates, kinds)
    model = MotionEmulator(
        motions.task,
        motions.skeleton,
        motions.mark_names,
        made.warps.shape[1],
        parts.flatten,
        parts.posture,
        parts.root,
        parts.pace,
        parts.bones,
        parts.margin,
        parts.mark_margins,
        parts.scale,
        crew,
        summary(made, parts, crew, settings, covariates.lines),
        parts.dwells,
        parts.footing,
    )
    if _is_gaussian(parts, len(crew.names), settings):
        return model
    crews = [(noise, _blurred(crew, parts, made.moving, covariates, curves, *noise)) for noise in NOISES]
    own, model = naturally([(noise, replace(model, workforce=blurred)) for noise, blurred in crews], motions)
    turns = BoneTurns.fit(made.directions.mean(axis=1), made.moving.worker_index, kinds.of, motions.skeleton)
    between, model = with_population(model, curves, motions, turns)
    report = summary(made, parts, model.workforce, settings, covariates.lines)
    methods = {"stiffness": stiffness_said(own, between)}
    if model.workforce.population is not None:
        methods["bones of new people"] = turns.said
    return replace(model, report=replace(report, methods=report.methods | methods))


def _crew(parts: Parts, motions: MotionSet, covariates: Covariates, kinds: Kinds) -> Workforce:
    """Who performs, by plain Gaussians."""
    index, n_workers, z = motions.worker_index, len(motions.workers), parts.z - covariates.within
    crew = Workforce.fit(z, index, motions.workers, *shrinkages(len(z), n_workers), covariates.told, kinds)
    return replace(crew, group=motions.source)


def _kinds(parts: Parts, motions: MotionSet, settings: FitSettings) -> Kinds:
    """The kind of each worker; postures, paths and paces depend on it, bones and times do not. A Gaussian has one."""
    index, n_workers = motions.worker_index, len(motions.workers)
    means = np.stack([parts.z[index == w].mean(axis=0) for w in range(n_workers)])
    if _is_gaussian(parts, n_workers, settings):
        return Kinds.one(*means.shape)
    differ = np.zeros(means.shape[1], bool)
    for name in CURVES:
        differ[parts.scale.block(name)] = True
    return Kinds.fit(kinds_of(motions), means, differ)


def _is_gaussian(parts: Parts, n_workers: int, settings: FitSettings) -> bool:
    """Whether Gaussians were asked for, or nothing varies within workers."""
    return settings.scheme.endswith("/MVG") or len(parts.z) == n_workers or parts.posture.n_components == 0


def _blurred(
    crew: Workforce,
    parts: Parts,
    motions: MotionSet,
    covariates: Covariates,
    curves: tuple[Curves, ...],
    stiffness: float,
    most_noise: float,
) -> Workforce:
    """Who performs, by recorded repetitions with noise about them."""
    centred, z = parts.flat - parts.posture.mean, parts.z - covariates.within
    gram, spread = centred @ centred.T, crew.within.spread
    scores = smoothed(z, motions.worker_index, spread, curves[0], curves[1:], gram, stiffness, most_noise)
    return replace(crew, smoothed=scores)


def _curves(parts: Parts) -> tuple[Curves, ...]:
    """The blocks of z that say curves over time: postures, root paths, paces; those without coordinates left out."""
    found = []
    for name, channels in zip(CURVES, (parts.flatten.n_channels, 4, 1)):
        pca: JointPCA = getattr(parts, name)
        block = parts.scale.block(name)
        if pca.n_components:
            second = np.diff(pca.basis.reshape(pca.n_components, -1, channels), n=2, axis=1)
            second = second.reshape(pca.n_components, -1)
            found.append(Curves(block, parts.scale.spread[block], np.asarray(second @ second.T)))
    return tuple(found)

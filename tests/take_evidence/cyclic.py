"""Cyclic motion with contact, after Remillard & Kry (2010): states found, feet that stand, pauses kept, no drift."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from emulator.cyclic.contacts import (
    contact_of,
    contact_of_state,
    foot_skate_m,
    found_states,
    path_from_contacts,
    single_support,
)
from emulator.cyclic.latent import PoseLatent, Poses, leg_length_m, path_of, poses_of, positions_of
from emulator.cyclic.switching_dynamics import SwitchingDynamics, distance
from emulator.motion import turn
from emulator.recordings.npz import read_recording
from emulator.recordings.take import Take
from emulator.skeleton import Skeleton, standard_skeleton
from tests.made.rowing import RATE_HZ, made_rowing
from tests.take_evidence import cyclic_figures as figures

STYLES = ("active", "elderly", "exhausted", "feminine", "masculine", "normal", "youthful")
INFERRED = 1000
DRAWN = 100_000
Line = tuple[str, str, bool]


class Walks(NamedTuple):
    """The takes of one style, their latents and states, and both models of them."""

    takes: list[Take]
    skeleton: Skeleton
    latent: PoseLatent
    z: list[np.ndarray]
    state: list[np.ndarray]
    switching: SwitchingDynamics
    single: SwitchingDynamics


def evidence(motion: Path, out: Path) -> Iterator[Line]:
    """(claim, what was found, whether the bound holds), and pictures as the paper's figures 1 to 3 in ``out``."""
    takes = read_recording(motion / "bandai2_walk.npz").takes
    yield _states(takes)
    walks = {style: walks_of([take for take in takes if take.covariates["cov_style"] == style]) for style in STYLES}
    yield _reduction(walks["normal"], out)
    yield from _skate(walks)
    yield from _manifold(walks, out)
    figures.walking(walks["normal"], out / "fig2_walking.png", INFERRED)
    yield from _rowing(out)


def walks_of(takes: list[Take]) -> Walks:
    """Three components of all takes together; the state is the foot that bears, found without labels."""
    skeleton = Skeleton(takes[0].names, takes[0].parents or ())
    poses = [poses_of(take.positions_m, skeleton, take.rate_hz) for take in takes]
    latent = PoseLatent.fit(poses, components=3)
    z = [latent.forward(one) for one in poses]
    state = [single_support(contact_of(take)) for take in takes]
    single = SwitchingDynamics.fit(z, state, switching=False, on_support=False)
    return Walks(takes, skeleton, latent, z, state, SwitchingDynamics.fit(z, state), single)


def _states(takes: tuple[Take, ...]) -> Line:
    agreed = [float(np.mean(contact_of(take) == take.contact)) for take in takes]
    found = f"mean {np.mean(agreed):.1%}, least {min(agreed):.1%} over {len(agreed)} takes"
    return (
        "states found without labels agree with contact_feet on 85 % of frames of each take",
        found,
        min(agreed) > 0.85,
    )


def _reduction(walks: Walks, out: Path) -> Line:
    """As figure 1: cumulative energy, and where the toes are after the reduction, root in place."""
    take = walks.takes[5]
    poses = poses_of(take.positions_m, walks.skeleton, take.rate_hz)
    whole = PoseLatent.fit([poses], components=10)
    errors = []
    for d in range(1, 11):
        back = whole.first(d).inverse(whole.first(d).forward(poses))
        errors.append(100 * np.linalg.norm(_toes(back, walks) - _toes(poses, walks), axis=-1).ravel())
    figures.reduction(whole.energy[:10], errors, out / "fig1_reduction.png")
    found = (
        f"energy {whole.energy[2]:.1%}, toes {errors[2].mean():.1f} cm off (10 components: {errors[9].mean():.1f} cm)"
    )
    return f"three components keep 90 % of a walk of {take.n_frames} poses", found, bool(whole.energy[2] >= 0.9)


def _toes(poses: Poses, walks: Walks) -> np.ndarray:
    length_m = walks.skeleton.bone_lengths(walks.takes[0].positions_m)[0]
    joints = walks.skeleton.positions(poses.directions, length_m, np.zeros((poses.n_frames, 3)))
    return joints[:, [walks.skeleton.index("left_toe"), walks.skeleton.index("right_toe")]]


def _skate(walks: dict[str, Walks]) -> Iterator[Line]:
    """Slide of a bearing foot a stance; who bears is found in each motion anew (``contact_of``), in all alike."""
    rows = {style: _slides_cm(one) for style, one in walks.items()}
    each = "; ".join(f"{style} " + "/".join(f"{cm:.1f}" for cm in row[:3]) for style, row in rows.items())
    recorded, single, switching, drawn, own_travel, lent = np.mean(list(rows.values()), axis=0)
    how = "1,000 poses by the mean; single: own travel, switching: the root rides on the foot that the state says bears"
    yield (
        f"foot skate a step at most half the single process's ({how})",
        f"{switching:.1f} cm against {single:.1f} cm; recorded/single/switching by style: {each}",
        bool(switching <= 0.5 * single and all(row[2] <= 0.5 * row[1] for row in rows.values())),
    )
    yield (
        "foot skate a step within 1.5 times the recording's, on average over the styles",
        f"{switching:.1f} cm against {recorded:.1f} cm, worst style {max(row[2] / row[0] for row in rows.values()):.2f}"
        f" times; drawn with the predictive variance {drawn:.1f} cm",
        bool(max(switching, drawn) <= 1.5 * recorded),
    )
    yield (
        "it is the state that keeps feet still, not the dynamics: on its own travel switching slides as the single one "
        "does, and the single one, lent the classifier's states to ride on, as switching does",
        f"switching on its own travel {own_travel:.1f} cm, single {single:.1f} cm; with lent states {lent:.1f} cm",
        bool(own_travel > 0.5 * single and lent < 0.5 * single),
    )


def _slides_cm(walks: Walks) -> tuple[float, ...]:
    """Recorded, single, switching, switching drawn, switching on own travel, single with lent states: cm a stance."""
    start = walks.z[0][100:101]
    alone = walks.single.sample(start, INFERRED, _rng(), noise=False)[0][0]
    along, state = walks.switching.sample(start, INFERRED, _rng(), noise=False)
    noisy, noisy_state = walks.switching.sample(start, INFERRED, _rng())
    recorded = np.concatenate([_slid_m(take.positions_m, walks) for take in walks.takes])
    ridden = [ridden_m(walks, z[0], which[0]) for z, which in ((along, state), (noisy, noisy_state))]
    lent = ridden_m(walks, alone, walks.switching.state(alone))
    motions = [travelled_m(walks, alone), *ridden, travelled_m(walks, along[0]), lent]
    slid = [100 * float(_slid_m(one, walks).mean()) for one in motions]
    return 100 * float(recorded.mean()), *slid


def _slid_m(positions_m: np.ndarray, walks: Walks) -> np.ndarray:
    contact = contact_of(positions_m, walks.skeleton, walks.takes[0].rate_hz)
    return foot_skate_m(positions_m, contact, walks.skeleton)


def travelled_m(walks: Walks, z: np.ndarray) -> np.ndarray:
    """Joints (T, J, 3) on the path that the latents foretell."""
    length_m = walks.skeleton.bone_lengths(walks.takes[0].positions_m)[0]
    return positions_of(walks.latent.inverse(z), walks.skeleton, length_m, walks.takes[0].rate_hz)


def ridden_m(walks: Walks, z: np.ndarray, state: np.ndarray) -> np.ndarray:
    """Joints (T, J, 3) whose root rides on the foot that the state says bears."""
    poses, length_m = walks.latent.inverse(z), walks.skeleton.bone_lengths(walks.takes[0].positions_m)[0]
    root, yaw = path_of(poses, leg_length_m(walks.skeleton, length_m), walks.takes[0].rate_hz)
    hanging = walks.skeleton.positions(turn(poses.directions, yaw[:, None]), length_m, np.zeros((len(z), 3)))
    way = path_from_contacts(hanging, contact_of_state(state), walks.skeleton)
    return hanging + np.column_stack([way, root[:, 2]])[:, None]


def _manifold(walks: dict[str, Walks], out: Path) -> Iterator[Line]:
    """Each of 100,000 drawn poses is nearer to a training pose than the farthest of those is to other takes."""
    shown: dict[str, Any] = {}
    for style in STYLES:
        one, frames = walks[style], np.concatenate(walks[style].z)
        drawn, _ = one.switching.sample(one.z[0][100:101], DRAWN, _rng())
        away = distance(drawn[0], frames)
        drifting = {
            "linear": _linear(one, 2000),
            "single, free": one.single.sample(one.z[0][100:101], 2000, _rng())[0][0],
        }
        lost = {name: float(distance(z, frames).max()) for name, z in drifting.items()}
        periods = (
            f"cycle {_cycle_frames(drawn[0]):.1f} frames, recorded {np.mean([_cycle_frames(z) for z in one.z]):.1f}"
        )
        shown[style] = (away[:2000], {name: distance(z, frames) for name, z in drifting.items()}, one.switching.bound)
        yield (
            f"{style}: {DRAWN:,} poses stay on the training manifold, controls do not",
            f"at most {away.max():.3f}, bound {one.switching.bound:.3f} ({periods}); in 2,000 poses the linear control "
            f"{lost['linear']:.2g}, a single process without support {lost['single, free']:.2g}",
            bool(away.max() <= one.switching.bound and min(lost.values()) > one.switching.bound),
        )
    figures.manifold(shown["normal"], out / "manifold.png")


def _linear(walks: Walks, n: int) -> np.ndarray:
    """The drifting control: z_{t+1} = A z_t + noise by least squares, drawn."""
    before, after = (np.concatenate([z[cut] for z in walks.z]) for cut in (slice(None, -1), slice(1, None)))
    way = np.linalg.lstsq(before, after, rcond=None)[0]
    spread = np.linalg.cholesky(np.cov((after - before @ way).T))
    rng, path = _rng(), [walks.z[0][100]]
    for _ in range(n - 1):
        path.append(path[-1] @ way + spread @ rng.standard_normal(len(spread)))
    return np.array(path)


def _cycle_frames(z: np.ndarray) -> float:
    """Mean length of a cycle: the first component goes from clearly below its mean to clearly above."""
    clear = z[np.abs(z[:, 0]) > 0.5, 0] > 0
    at = np.flatnonzero(np.abs(z[:, 0]) > 0.5)[1:][~clear[:-1] & clear[1:]]
    return float((at[-1] - at[0]) / (len(at) - 1))


def _rowing(out: Path) -> Iterator[Line]:
    takes, truth = made_rowing()
    poses = [poses_of(take, standard_skeleton(), RATE_HZ) for take in takes]
    latent = PoseLatent.fit(poses, components=3)
    z = [latent.forward(one) for one in poses]
    states = found_states(z, 3, RATE_HZ)
    speed, paused = _speeds(z), np.concatenate([state[:-1] for state in truth]) == 0
    limit = float(np.sqrt(np.median(speed[paused]) * np.median(speed[~paused])))
    switching = SwitchingDynamics.fit(z, states)
    single = SwitchingDynamics.fit(z, states, switching=False, on_support=False)
    paths = {name: one.sample(z[0][:1], 3000, _rng()) for name, one in (("single", single), ("switching", switching))}
    still = {name: float(np.mean(_speeds([path[0][0]]) < limit)) for name, path in paths.items()}
    recorded = float(np.mean(speed < limit))
    agreed = np.mean((np.concatenate(states) == 0) == (np.concatenate(truth) == 0))
    figures.rowing(takes[0], z, states, paths, out / "fig3_rowing.png", INFERRED)
    yield (
        "share of still frames in made push-pause-pull kept within a tenth, with states found without labels",
        f"recorded {recorded:.3f}, switching {still['switching']:.3f}, single {still['single']:.3f} "
        f"(pauses found right in {agreed:.1%} of frames)",
        bool(abs(still["switching"] / recorded - 1) < 0.1),
    )


def _speeds(sequences: list[np.ndarray]) -> np.ndarray:
    return np.concatenate([np.linalg.norm(np.diff(z, axis=0), axis=1) for z in sequences])


def _rng() -> np.random.Generator:
    return np.random.default_rng(7)

"""Walking of any length: drawn walks over their footprints, slide of feet, durations and steps against law."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from emulator.motion import stretches

SPEEDS_M_PER_S, HEIGHTS_M = (0.7, 1.2, 1.7), (1.55, 1.90)
WALKS, LONG_M = 240, 3000.0
SHIPPED = Path(__file__).parents[2] / "scenarios" / "libraries" / "walking.npz"


def evidence(motion: Path, out: Path) -> Iterator[tuple[str, str, bool]]:
    """Claims about the shipped walking, and about a fit of the recorded walks in ``motion``."""
    from emulator.model.library import MotionLibrary

    model = MotionLibrary.load(SHIPPED)["walk"]
    yield from _planted(model, out)
    yield from _near(model)
    yield from _durations(model)
    yield _steps(model, out)
    yield _ends(model)
    yield _speed(model)
    yield from _recorded(motion, out)


def _walks(model, distance_m=4.0):
    for speed in SPEEDS_M_PER_S:
        for height in HEIGHTS_M:
            worker = model.draw_worker(np.random.default_rng(3), {"height_m": height})
            condition = {"distance_m": distance_m, "speed_m_per_s": speed}
            yield speed, height, model.sample(1, np.random.default_rng(7), worker=worker, condition=condition)


def _planted(model, out):
    from emulator.cyclic.contacts import foot_skate_m
    from opsim.report.sections.walking import draw_walks, walk_of

    slid, stretched, rows = [], [], []
    for speed, height, one in _walks(model):
        rows.append(walk_of(f"{speed} m/s, {height:.2f} m tall", one))
        at = np.arange(0.0, one.duration_s[0], 1 / 60)
        positions = one.positions_m(at)[0]
        slid.append(foot_skate_m(positions, one.contact(at)[0], model.skeleton).max())
        stretched.append(np.ptp(model.skeleton.bone_lengths(positions), axis=0).max())
    draw_walks(rows, out / "walks.png", model.skeleton, title="Drawn walks at three speeds, by two statures")
    yield "feet that bear stay", f"at most {1000 * max(slid):.2f} mm in a stance (1.5 mm)", max(slid) < 1.5e-3
    yield "bones keep their length", f"within {max(stretched):.0e} m (1e-9)", max(stretched) < 1e-9


def _near(model):
    """Draws beside the model's own training poses, in the latents that the dynamics move: nearest distances."""
    from emulator.cyclic.switching_dynamics import distance, held_out_distances

    takes = _training(model)
    frames = np.concatenate(takes)
    bound = float(np.concatenate(held_out_distances(takes)).max())
    many, (long,) = (_latents(model, n, metres) for n, metres in ((WALKS, 10.0), (1, LONG_M)))
    away = [distance(z, frames) for z in (*many, long)]
    every, beyond = np.concatenate(away), [one > bound for one in away]
    lasts = max((stop - start for one in beyond for start, stop in stretches(one)), default=0)
    half = len(long) // 2
    free, linear = (float(distance(z, frames).max()) for z in (_free(model, half), _linear(takes, half)))
    share = float(np.mean(every > bound))
    found = (
        f"{len(every):,} poses of {WALKS} walks of 10 m and one of {LONG_M / 1000:g} km; the training's own maximum "
        f"(a take to the others) is {bound:.3f}, draws come to {every.max():.3f}, {every.max() / bound:.2f} times: "
        f"{100 * share:.3f} % of poses are beyond it, for at most {lasts} frames at a time; first and second half of "
        f"the long way: at most {away[-1][:half].max():.3f} and {away[-1][half:].max():.3f}, median "
        f"{np.median(away[-1][:half]):.3f} and {np.median(away[-1][half:]):.3f}; in {half:,} poses the same dynamics "
        f"without guide come to {free:.2g}, a linear control to {linear:.2g}"
    )
    holds = share < 0.001 and every.max() < 2 * bound < min(free, linear) and lasts < 2 * model.beat_frames[1]
    claim = "shipped walking does not drift: 99.9 % of poses are within the training's own maximum, "
    yield claim + "all within twice (not each within once), what is beyond is back within a stride", found, bool(holds)


def _training(model):
    """Latents (T, d) of the takes that the shipped library is fitted to, without the workers' own offsets."""
    from emulator.cyclic.preparation import prepared
    from emulator.synthetic.walking import make_walks

    recording, _ = make_walks(len(model.workers), model.report.n_sequences // len(model.workers), seed=0)
    assert len(recording.takes) == model.report.n_sequences
    parts = [prepared(take, model.skeleton, True) for take in recording.takes]
    own = [model.known_worker(part.take.worker).z for part in parts]
    return [(model.latent.forward(part.poses) - z)[:, : model.n_moved] for part, z in zip(parts, own)]


def _latents(model, n, distance_m):
    """The same of n drawn walks, from standing to standing."""
    drawn = model.sample(n, np.random.default_rng(7), condition={"distance_m": distance_m})
    return [(track.line.z - own)[:, : model.n_moved] for track, own in zip(drawn.tracks, drawn.offset)]


def _free(model, n):
    """n poses of the dynamics alone, with all of their spread: no beat is asked for, and none is drawn again."""
    start, known = model.entries[0].z[:1, : model.n_moved], np.zeros((1, model.dynamics.n_controls))
    return model.dynamics.sample(start, n, np.random.default_rng(7), controls=known)[0][0]


def _linear(takes, n):
    """z_{t+1} = A z_t + b + noise by least squares: what keeps to no cycle."""
    before, after = (np.concatenate([z[cut] for z in takes]) for cut in (slice(None, -1), slice(1, None)))
    before = np.column_stack([before, np.ones(len(before))])
    way = np.linalg.lstsq(before, after, rcond=None)[0]
    spread = np.linalg.cholesky(np.cov((after - before @ way).T))
    rng, path = np.random.default_rng(7), [after[100]]
    for _ in range(n - 1):
        path.append(np.append(path[-1], 1.0) @ way + spread @ rng.standard_normal(len(spread)))
    return np.array(path)


def _durations(model):
    for distance_m, speed in ((3.0, 1.0), (8.0, 1.3), (50.0, 1.6)):
        condition = {"distance_m": distance_m, "speed_m_per_s": speed}
        many = model.sample(2000, np.random.default_rng(11), condition=condition).duration_s
        half = 1.96 * many.std(ddof=1) / np.sqrt(len(many))
        found = f"{many.mean():.3f} +/- {half:.3f} s, CV {100 * many.std() / many.mean():.1f} %"
        yield (
            f"{distance_m:g} m at {speed} m/s take {distance_m / speed:.3f} s",
            found,
            abs(many.mean() - distance_m / speed) < half,
        )


def _steps(model, out):
    """Of the typical worker, long ways: step length against the walk ratio that the made walks were given."""
    from matplotlib.figure import Figure

    from emulator.synthetic.gait import step_length_m
    from opsim.report.plot.body import LEFT, RIGHT

    figure = Figure(figsize=(7.0, 4.2), facecolor="white")
    axes, off = figure.add_subplot(), []
    for colour, height in zip((LEFT, RIGHT), HEIGHTS_M):
        worker = model.draw_worker(np.random.default_rng(3), {"height_m": height, "person": "w1"})
        leg = float(model.channel.leg_m(worker.bone_length_m)) * 0.92 / 0.84
        speeds = np.linspace(0.5, 2.0, 9)
        found, law = [], [step_length_m(v, leg) for v in speeds]
        for v in speeds:
            one = model.sample(
                1, np.random.default_rng(0), worker=worker, condition={"distance_m": 200.0, "speed_m_per_s": v}
            )
            found.append(200.0 / np.isfinite(one.beat_s).sum())
        own = np.exp(np.mean(np.log(found) - np.log(law)))
        off.append(np.abs(np.array(found) / (own * np.array(law)) - 1).max())
        axes.plot(speeds, found, "o", color=colour, label=f"{height:.2f} m tall, drawn")
        axes.plot(speeds, own * np.array(law), color=colour, lw=1.2, label="walk ratio, at this person's level")
    axes.set(xlabel="speed (m/s)", ylabel="step (m)", title="Step length follows speed and leg")
    axes.spines[["top", "right"]].set_visible(False)
    axes.legend(frameon=False, fontsize=8)
    figure.tight_layout()
    figure.savefig(out / "steps.png", dpi=130)
    return "step length follows the square root of the speed", f"within {100 * max(off):.1f} % (5 %)", max(off) < 0.05


def _ends(model):
    off = []
    for distance_m in (0.3, 1.0, 2.5, 10.0, 100.0):
        one = model.sample(1, np.random.default_rng(2), condition={"distance_m": distance_m})
        off.append(abs(one.root_m(one.duration_s)[0, -1, 0] - distance_m))
    return "ways of 0.3 to 100 m end where they shall", f"within {100 * max(off):.2f} cm (1 cm)", max(off) < 0.01


def _speed(model):
    import time

    model.sample(2, np.random.default_rng(0), condition={"distance_m": 10.0})
    start = time.perf_counter()
    many = model.sample(500, np.random.default_rng(0), condition={"distance_m": 10.0})
    ratio = many.duration_s.sum() / (time.perf_counter() - start)
    few = many[:40]
    few[:1].positions_m(n_times=10)
    start = time.perf_counter()
    for k in range(len(few)):
        few[k].positions_m(np.arange(0.0, few.duration_s[k], 1 / 30))
    with_postures = few.duration_s.sum() / (time.perf_counter() - start)
    found = f"{ratio:.0f} times real time (1000); postures at 30 Hz besides: {with_postures:.0f} times"
    return "walking is drawn faster than it is walked", found, ratio > 1000


def _recorded(motion, out):
    """Fitted to recordings, from which nothing is shipped."""
    from emulator.cyclic.model import CyclicEmulator
    from emulator.recordings.npz import read_recording
    from opsim.report.sections.walking import draw_walks, walk_of

    model = CyclicEmulator.fit(read_recording(motion / "bandai2_walk.npz"))
    report = model.report
    found = f"{report.skate_recorded_cm:.2f} cm recorded, {report.skate_drawn_cm:.3f} cm drawn, a stance"
    yield "fitted to bandai2_walk, feet do not slide", found, report.skate_drawn_cm < 0.15
    found = f"{report.step_m[0]:.3f} m recorded, {report.step_m[2]:.3f} m drawn"
    yield "steps are as long as recorded", found, abs(report.step_m[2] / report.step_m[0] - 1) < 0.03
    drawn = model.sample(2, np.random.default_rng(0))
    rows = [walk_of(f"drawn after bandai2_walk, {k + 1}", drawn[k]) for k in range(2)]
    draw_walks(
        rows, out / "recorded.png", model.skeleton, title="Fitted to recorded walks: begins and ends in the cycle"
    )

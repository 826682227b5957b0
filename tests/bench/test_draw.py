"""Drawing, decoding and fitting: the answer is asserted first, then what it costs. Run by ``make bench``."""

import subprocess
import sys
from dataclasses import replace
from functools import cache, partial
from pathlib import Path

import numpy as np
import pytest
from bench.cpu import best_s
from scipy.interpolate import CubicSpline

from emulator import Target
from emulator.geometry import sphere
from emulator.geometry.alignment import align
from emulator.model import decoding as decode
from emulator.model.emulator import MotionEmulator
from emulator.motion import turn
from emulator.synthetic.tasks import make

N, N_TIMES = 1000, 301


@cache
def on_feet():
    """A lift by five people, 301 points, 20 bones."""
    return MotionEmulator.fit(make("lift", 5, 8, seed=4)[0], n_times=N_TIMES)


@cache
def emulator():
    """The same without feet, as plain numpy decodes it."""
    return replace(on_feet(), footing=None)


def plain_directions(model, rng):
    """Draw and decode in plain numpy, all at once."""
    drawn = model.sample(N, rng)
    own, cells = np.linspace(0, 1, N_TIMES), np.arange(float(N_TIMES))
    place = np.stack([np.interp(own, warp, cells) for warp in model.warps(drawn.scores)])
    coefficients = model.scale.raw(drawn.scores, "posture")
    return turned(decode.directions_numpy(model.posture, model.flatten, coefficients, place), drawn)


def turned(directions, drawn):
    """Bones turned one by one, in plain numpy."""
    return np.einsum("nbij,nsbj->nsbi", sphere.matrices(drawn.turns), directions)


def our_directions(model, rng, dtype):
    return model.sample(N, rng).directions(n_times=N_TIMES, dtype=dtype)


@pytest.mark.parametrize(("dtype", "error", "at_least"), [(np.float32, 1e-5, 18), (np.float64, 1e-10, 9)])
def test_a_thousand_sequences_are_drawn_and_decoded(dtype, error, at_least):
    model = emulator()
    assert model.skeleton.n_bones == 20
    ours, plain = (f(model, np.random.default_rng(1)) for f in (partial(our_directions, dtype=dtype), plain_directions))
    assert ours.shape == (N, N_TIMES, 20, 3) and np.abs(ours - plain).max() < error
    del ours, plain
    plain_s, ours_s = best_s(
        lambda: plain_directions(model, np.random.default_rng(1)),
        lambda: our_directions(model, np.random.default_rng(1), dtype),
    )
    ratio = plain_s / ours_s
    each = ours_s / N / N_TIMES / 20 * 1e9
    print(
        f"\n1,000 x 301 x 20 directions, {np.dtype(dtype)}: {each:.1f} ns a bone, plain numpy in float64 x {ratio:.0f}"
    )
    assert ratio > at_least


def plain_positions(model, rng):
    """Draw, decode and stand in plain numpy, all at once."""
    drawn = model.sample(N, rng)
    own, cells = np.linspace(0, 1, N_TIMES), np.arange(float(N_TIMES))
    place = np.stack([np.interp(own, warp, cells) for warp in model.warps(drawn.scores)])
    coefficients = model.scale.raw(drawn.scores, "posture")
    between = turned(decode.directions_numpy(model.posture, model.flatten, coefficients, place), drawn)
    aligned = turned(model.aligned_directions(drawn.scores), drawn)
    root, yaw = model.channel.inverse_numpy(model.root_channel(drawn.scores), aligned, drawn.bone_length_m)
    course = np.concatenate([root, yaw[..., None]], axis=-1)
    path = np.stack([CubicSpline(cells, way)(at) for way, at in zip(course, place)])
    root, yaw = path[..., :3], path[..., 3]
    return model.skeleton.positions(turn(between, yaw[..., None]), drawn.bone_length_m[:, None], root)


def test_a_thousand_bodies_are_drawn_and_stand():
    model = emulator()
    ours = model.sample(N, np.random.default_rng(1)).positions_m(n_times=N_TIMES)
    assert np.abs(ours - plain_positions(model, np.random.default_rng(1))).max() < 1e-10
    del ours
    plain_s, ours_s = best_s(
        lambda: plain_positions(model, np.random.default_rng(1)),
        lambda: model.sample(N, np.random.default_rng(1)).positions_m(n_times=N_TIMES),
        rounds=3,
    )
    each = ours_s / N / N_TIMES * 1e6
    print(f"\n1,000 x 301 bodies of 21 joints on the floor: {each:.2f} us a body, plain numpy x {plain_s / ours_s:.0f}")
    assert plain_s / ours_s > 8


def test_feet_cost_about_as_much_as_decoding_does():
    without, with_feet = best_s(
        *(
            partial(lambda model: model.sample(N, np.random.default_rng(1)).positions_m(n_times=N_TIMES), model)
            for model in (emulator(), on_feet())
        ),
        rounds=3,
    )
    print(f"\n1,000 x 301 bodies: with feet x {with_feet / without:.2f} (target 1.5)")
    assert with_feet < 3 * without  # as much again, a tenth of it draws that are drawn in


@pytest.mark.parametrize(("block", "at_most_us"), [(64, 3.0), (4096, 2.0)])
def test_durations_and_marks_are_drawn_in_two_microseconds(block, at_most_us):
    model = emulator()
    blocks = 4096 // block
    effect = model.draw_worker(np.random.default_rng(0))

    def times(worker, rng):
        for _ in range(blocks):
            drawn = model.sample(block, rng, worker=worker)
            assert drawn.mark_s.shape == (block, 2)

    few = model.sample(block, np.random.default_rng(2))
    whole = model.warps(few.scores)
    by_hand = [np.interp(few.mark_s[i] / few.duration_s[i], whole[i], np.linspace(0, 1, N_TIMES)) for i in range(block)]
    clock = np.stack([np.interp(at, np.linspace(0, 1, N_TIMES), warp) for at, warp in zip(by_hand, whole)])
    assert np.abs(clock * few.duration_s[:, None] - few.mark_s).max() < 1e-10
    known, any_one = best_s(
        lambda: times(effect, np.random.default_rng(3)), lambda: times(None, np.random.default_rng(3)), rounds=40
    )
    print(
        f"\nduration and two marks, blocks of {block}: {known / 4096 * 1e6:.2f} us a draw of a worker, "
        f"{any_one / 4096 * 1e6:.2f} us each by another worker (target 2)"
    )
    assert known / 4096 * 1e6 < at_most_us  # small blocks are mostly calls: 1.9 us on a quiet machine


def test_a_fit_of_80_sequences_costs_a_few_times_its_alignment():
    motions, _ = make("lift", 8, 10, seed=4)
    directions = [motion.directions for motion in motions.motions]
    align_s, fit_s = best_s(
        lambda: align(directions, n_times=N_TIMES), lambda: MotionEmulator.fit(motions, n_times=N_TIMES), rounds=2
    )
    print(f"\nfit of 80 sequences at 301 points: {fit_s / align_s:.2f} x its alignment (target 3)")
    assert fit_s < 5 * align_s  # draws of 200 bodies tell how stiff its noise must be


PEAK = """
import re
import numpy as np
from emulator.model.emulator import MotionEmulator
from emulator.synthetic.tasks import make
def peak():
    return re.search(r"VmHWM:\\s*(\\d+) kB", open("/proc/self/status").read())[1]
model = MotionEmulator.fit(make("lift", 30, 10, seed=4)[0], n_times=301)
fitted = peak()
positions = model.sample(300, np.random.default_rng(0)).positions_m(n_times=301)
assert positions.shape == (300, 301, 21, 3)
print(fitted, peak())
"""


@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="the system does not tell the peak of memory")
def test_300_sequences_are_fitted_and_decoded_in_a_gigabyte():
    done = subprocess.run([sys.executable, "-c", PEAK], capture_output=True, text=True, check=True)
    fitted, decoded = (int(word) / 1024 for word in done.stdout.split())
    print(f"\n300 x 301 x 20: peak {fitted:.0f} MB after the fit, {decoded:.0f} MB after decoding 300 (target 1,000)")
    assert decoded < 1000


def test_a_place_costs_milliseconds_once_and_draws_hardly_anything():
    """A worker's law given a target, for the first height of all and for the next; then blocks of 64 draws."""
    model = replace(on_feet())
    worker = model.draw_worker(np.random.default_rng(0))

    def law(height_m, fresh):
        if fresh:
            model.__dict__.pop("_trends", None)
        model.given(Target("hands", "grasp", height_m=height_m)).law(worker)

    low = model.given(Target("hands", "grasp", height_m=0.5))
    few = low.sample(8, np.random.default_rng(1), worker=worker)
    hands = [model.skeleton.names.index(f"{side}_wrist") for side in ("left", "right")]
    assert np.abs(few.positions_m(few.mark_s)[:, 0, hands, 2].mean(axis=1) - 0.5).max() < 0.005
    first, next_one = best_s(lambda: law(0.6, True), lambda: law(0.7, False), rounds=20)
    free, given = best_s(
        *(partial(one.sample, 64, np.random.default_rng(2), worker=worker) for one in (model, low)), rounds=200
    )
    print(
        f"\na worker's law at a place: {first * 1e3:.1f} ms, at the next height {next_one * 1e3:.1f} ms (target 20); "
        f"draws x {given / free:.2f} (target 1.1)"
    )
    assert next_one < 0.04 and given < 1.2 * free  # 18 ms on a quiet machine

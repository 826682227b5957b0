"""A task of several motions: times add up, marks follow one another, and the bodies are joined where motions meet."""

import numpy as np

from emulator import CompositeEmulator, MotionLibrary, Part
from emulator.composite.joining import joined, posture_gap_rad
from emulator.synthetic import make
from opsim.shipped import shipped_folder

# Drawn: a kit is reached for, picked, carried, placed, and fastened twice. Each part has a draw of its own.
bench = MotionLibrary.load(shipped_folder() / "libraries" / "bench_work.npz")
names = ("reach", "pick", "carry", "place", "fasten", "fasten")
kit = CompositeEmulator("kit", tuple(Part(name, bench[name]) for name in names))
ana = kit.draw_worker(np.random.default_rng(1), {"height_m": 1.62})
drawn = kit.sample(200, np.random.default_rng(2), worker=ana)
print(f"a kit takes her {drawn.duration_s.mean():.1f} s, {kit.mean_duration_s(ana):.1f} s by the parts' own means")
print(f"in the first: {', '.join(f'{n} {s:.1f} s' for n, s in zip(kit.mark_names, drawn.mark_s[0]))}")
for join in kit.joins():
    print(f"{join.before} -> {join.after}: {np.degrees(join.gap_rad):.0f} degrees apart")

# Nothing jumps: directions of bones a millisecond before, at, and after each join.
at_s = drawn.stop_s[:, :-1, None] + np.array([-1e-3, 0.0, 1e-3])
near = drawn.directions(times_s=at_s.reshape(len(drawn), -1)).reshape(200, len(names) - 1, 3, -1, 3)
jump = np.linalg.norm(np.diff(near, n=2, axis=2), axis=-1).max() / 1e-3
print(f"the greatest jump of a bone's speed at a join: {jump:.2f} rad/s")

# The same with recorded repetitions, one after the other.
pick, place = (make(task, 1, 1, seed=3)[0].motions[0] for task in ("pick", "place"))
both = joined([pick, place])
print(f"{pick.duration_s:.3f} s + {place.duration_s:.3f} s = {both.duration_s:.3f} s, marks at {both.mark_s.round(2)}")
print(f"they meet {np.degrees(posture_gap_rad(pick, place)):.0f} degrees apart")

"""Draw performances of a recorded movement: durations at once, postures when they are asked for."""

import numpy as np

from emulator import MotionLibrary
from opsim.shipped import shipped_folder

library = MotionLibrary.load(shipped_folder() / "libraries" / "public_movements.npz")
squat = library["deep_squat"]
print(f"{squat.task}: {squat.report.n_sequences} recordings of {squat.report.n_workers} people")

drawn = squat.sample(200, np.random.default_rng(1))
print(f"duration: mean {drawn.duration_s.mean():.2f} s, the model's own mean {squat.mean_duration_s():.2f} s")
print(f"turn at {np.median(drawn.mark_s[:, 0] / drawn.duration_s):.0%} of the time (median)")

worker = squat.draw_worker(np.random.default_rng(2))
his = squat.sample(200, np.random.default_rng(1), worker=worker)
print(
    f"one worker: mean {his.duration_s.mean():.2f} s, "
    f"spread {his.duration_s.std() / drawn.duration_s.std():.0%} of everybody's"
)

pelvis = drawn.skeleton.index("pelvis")
height_m = drawn[:20].positions_m(n_times=21)[:, :, pelvis, 2]
print(f"the pelvis sinks by {np.median(height_m[:, 0] - height_m.min(axis=1)):.1f} m")

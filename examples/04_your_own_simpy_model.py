"""A packing bench in plain SimPy, with two opsim workers in it: their times and their bodies come from recordings."""

import numpy as np
import simpy

from opsim import Worker, WorkerLog, stream
from opsim.log import WORK

SHIFT_S = 3600.0
MOVES = {  # library/task: a shipped library by its name, your own by its path
    "lift": "public_movements/deep_squat",
    "pack": "public_movements/side_lunge",
    "stow": "public_movements/shoulder_scaption",
}


def boxes_arrive(env, boxes):
    rng = stream(1, 0, "boxes")
    while True:
        yield env.timeout(rng.exponential(11.0))
        yield boxes.put("box")


def packer(worker, boxes, bench, done):
    while True:
        yield boxes.get()
        done.append((yield worker.perform("lift")))
        with bench.request() as place:
            yield place
            for _ in range(3):
                done.append((yield worker.perform("pack")))
        done.append((yield worker.perform("stow")))


def sinks_m(performance):
    """How far the pelvis sinks."""
    height_m = performance.positions_m(n_times=41)[:, performance.skeleton.index("pelvis"), 2]
    return height_m[0] - height_m.min()


env, log, done = simpy.Environment(), WorkerLog(), []
boxes, bench = simpy.Store(env), simpy.Resource(env, capacity=1)
for name, height_m in (("ana", 1.62), ("ben", 1.85)):
    worker = Worker(env, name, MOVES, seed=1, body={"height_m": height_m}, log=log)
    env.process(packer(worker, boxes, bench, done))
env.process(boxes_arrive(env, boxes))
env.run(until=SHIFT_S)

rows = log.close()
packed = sum(performance.task == "stow" for performance in done)
print(f"{packed / SHIFT_S * 3600:.0f} boxes an hour, {len(boxes.items)} still on the floor")
for rank, name in enumerate(rows.names["worker"]):
    work = rows.where((rows["kind"] == WORK) & (rows["worker"] == rank))
    depths_m = [sinks_m(p) for p in done if p.worker == name and p.task == "lift"]
    print(
        f"{name}: at work {work.duration_s.sum() / SHIFT_S:.0%} of the time; "
        f"{len(depths_m)} squats, {np.mean(depths_m):.2f} m deep, the deepest {max(depths_m):.2f} m"
    )

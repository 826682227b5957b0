"""Your own SimPy model, and what it asks of bodies: two packers, first untiring, then not, and how they are scored."""

import simpy

from opsim import Worker, WorkerLog, exposure_of

SHIFT_S, BREAK_S = 2 * 3600.0, 900.0
MOVES = {"lift": "bench_work/stoop", "pack": "bench_work/fasten"}
STANDS = {"forearm": "mid", "legs": "balanced", "sitting": False, "arms_supported": False, "rapid": False}
HANDLING = {  # what no posture tells; what is left out makes a score an interval
    "lift": {**STANDS, "load_kg": 8, "grip": "fair"},
    "pack": {**STANDS, "load_kg": 0},
}
TIRES = {"fatigue": {"model": "lffrm", "tires_half_in": "1 h", "recovers_half_in": "15 min", "slows": 0.3}}


def packer(worker, boxes, packed):
    while True:
        yield boxes.get()
        yield worker.perform("lift")
        for _ in range(3):
            yield worker.perform("pack")
        packed.append(worker.env.now)
        if worker.fatigue > 0.35:  # a rest by need is your model's to give
            yield worker.env.timeout(BREAK_S)


def arrivals(env, boxes):
    while True:
        yield boxes.put("box")
        yield env.timeout(12.0)


def shift(human):
    env, log, packed = simpy.Environment(), WorkerLog(), []
    boxes = simpy.Store(env)
    for name, height_m in (("ana", 1.62), ("ben", 1.85)):
        how = {"body": {"height_m": height_m}, "handling": HANDLING, "human": human}
        env.process(packer(Worker(env, name, MOVES, seed=1, log=log, **how), boxes, packed))
    env.process(arrivals(env, boxes))
    env.run(until=SHIFT_S)
    return len(packed), exposure_of(log, start_s=6 * 3600.0)


for name, human in (("nobody tires", None), ("people tire", TIRES)):
    n_packed, seen = shift(human)
    low, high = (seen.value("rula_from_5_min_per_h", "", part) for part in ("", "at_most"))
    print(f"{name}: {n_packed / SHIFT_S * 3600:.0f} boxes an hour; RULA 5 or more {low:.1f} to {high:.1f} min an hour")
    print(f"{seen}\n")
worst = seen.worst(1)[0]  # while one rests the other lifts every 19 s: 4 times in a minute is repeated, one point more
print(f"worst: {worst.worker}, {worst.task}, {worst.clock}, RULA {worst.rula[0]}, repeated: {worst.repeated}")

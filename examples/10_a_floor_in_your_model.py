"""A supplier and a lorry in plain SimPy, and between them a whole opsim floor, the shipped repacking cell."""

import simpy

from opsim import Floor, audit, compile_plan, figures, read_scenarios, stream
from opsim.shipped import shipped_folder

FIRST_LORRY_S, LORRY_EVERY_S, LORRY_HOLDS = 1800.0, 3600.0, 90


def hand_over(env, floor, stays_s):
    """Somebody's carton goes through the floor as those of its own source do; we wait until it has left."""
    left = yield floor.release("carton")
    if left.what == "finished":
        stays_s.append(left.stay_s)


def supplier(env, floor, stays_s):
    """Five cartons every twenty minutes or so, beside what the scenario brings in itself."""
    rng = stream(1, 0, "supplier")
    while True:
        yield env.timeout(rng.uniform(1000.0, 1400.0))
        for _ in range(5):
            env.process(hand_over(env, floor, stays_s))


def lorry(env, floor, loads):
    """Waits at the floor's door until it is full, or for ten minutes."""
    yield env.timeout(FIRST_LORRY_S)
    while True:
        leaves, load = env.timeout(600.0), []
        while len(load) < LORRY_HOLDS and not leaves.processed:
            nearest = floor.leaving.get()
            yield nearest | leaves
            if nearest.triggered:
                load.append(nearest.value)
            else:
                nearest.cancel()
        loads.append((env.now, len(load)))
        yield env.timeout(LORRY_EVERY_S)


plan = compile_plan(read_scenarios(shipped_folder() / "repack_cell.yaml")["base"])
env, stays_s, loads = simpy.Environment(initial_time=6 * 3600), [], []  # our clock says 06:00
floor = Floor(env, plan)
env.process(supplier(env, floor, stays_s))
env.process(lorry(env, floor, loads))

env.run(until=10 * 3600)
log, so_far = floor.log(), floor.plan_so_far()
print(f"at 10:00: {len(log)} rows, {len(audit(log, so_far))} laws hold")
env.run(until=floor.ended)
for at_s, n in loads:
    print(f"{at_s // 3600:02.0f}:{at_s % 3600 // 60:02.0f} a lorry leaves with {n}")
print(f"{len(floor.leaving.items)} wait for the next one")
print(f"the supplier's cartons: {len(stays_s)} done, {sum(stays_s) / len(stays_s) / 60:.1f} min on the floor")
made = next(f for f in figures(floor.log(), plan) if f.kpi == "throughput_per_h" and not f.subject)
print(f"the floor: {made.value:.0f} jobs an hour")

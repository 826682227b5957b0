"""A walk through the parts: perform, interrupt, resume, then the rows, a query and the body. Cell by cell (# %%)."""

# %% A worker lives in your environment. Tasks are models of time, or movements out of a library.
import tempfile
from pathlib import Path

import duckdb
import numpy as np
import simpy

from opsim import Worker, write_events
from opsim.tasks import Lognormal

env = simpy.Environment(initial_time=6 * 3600)  # the clock is yours: here seconds since midnight
ana = Worker(env, "ana", {"fasten": "bench_work/fasten", "label": Lognormal(20.0, cv=0.25)}, seed=7)

# %% A performance is a process. Its value says what was done.
done = env.run(ana.perform("fasten"))
print(f"{done.task} {done.k}: {done.start_s:.0f} to {done.end_s:.2f} s, screwing from {done.mark_s[0]:.2f} s on")

# %% Who is busy stays busy.
label = ana.perform("label")
try:
    ana.perform("fasten")
except RuntimeError as busy:
    print(str(busy).partition(";")[0])


# %% A rush order comes in: stop, do it, go on where the work stopped.
def rush(env, ana, doing):
    yield env.timeout(5.0)
    doing.interrupt("rush order")
    piece = yield doing
    print(f"{piece.task} stopped at {piece.progress_to:.0%}, finished: {piece.finished}, {piece.left_s:.2f} s left")
    yield ana.perform("fasten")
    return (yield ana.resume(piece))


rest = env.run(env.process(rush(env, ana, label)))
print(f"{rest.task} {rest.k} resumed at {rest.progress_from:.0%}, finished: {rest.finished}, {rest.end_s:.2f} s")

# %% What happened stands in the log, one row for each stretch; here as SQL sees it.
log = ana.log.close()
with tempfile.TemporaryDirectory() as folder:
    write_events(log, Path(folder) / "events.parquet")
    rows = duckdb.sql(
        "SELECT task, count(DISTINCT k), round(sum(end_s - start_s), 2), count(*) "
        f"FROM '{folder}/events.parquet' WHERE kind = 'work' GROUP BY task ORDER BY task"
    ).fetchall()
for task, performances, seconds, pieces in rows:
    print(f"{task}: {performances} performance(s) in {pieces} piece(s), {seconds} s")

# %% And the body behind any performance is there for the asking, long after the run.
hand = done.skeleton.index("right_hand")
way_m = np.linalg.norm(np.diff(done.positions_m()[:, hand], axis=0), axis=1).sum()
print(f"right hand: {way_m:.1f} m in {done.duration_s:.1f} s")


# %% A piece of a performance is a piece of its movement: after tea you go on from where you had stopped.
def tea(env, ana):
    doing = ana.perform("fasten")
    yield env.timeout(2.0)
    doing.interrupt("tea")
    before = yield doing
    yield env.timeout(600.0)
    return before, (yield ana.resume(before))


before, after = env.run(env.process(tea(env, ana)))
jump_mm = 1000 * np.abs(before.positions_m()[-1] - after.positions_m()[0]).max()
print(f"fasten in two pieces, parted at {after.progress_from:.0%}: {jump_mm:.3f} mm from one posture to the next")

"""Studies from Python: the best of four rules for a repair bench of plain SimPy, whether to believe its long run, and a
shipped scenario swept in three lines."""

import numpy as np
import simpy

from opsim import stream
from opsim.study.jobs import Answers, Job, Point, Source
from opsim.study.long_run import batch_means, flags
from opsim.study.select import each, kn

RULES = {  # a repair -> its rank among those that wait: the lowest comes first
    "first come first served": lambda number, work_h: number,
    "last come first served": lambda number, work_h: -number,
    "short ones first": lambda number, work_h: work_h,
    "long ones first": lambda number, work_h: -work_h,
}


def days_in_the_shop(rule, replication, n=250):
    """(n,) how long each of n repairs is there, two people at the bench, in the order of leaving."""
    rng = stream(5, replication, "repairs")  # the same repairs whatever the rule: their luck is shared
    gaps_h, works_h = rng.exponential(1.0, n), rng.gamma(2.0, 0.9, n)
    env, left = simpy.Environment(), []
    bench = simpy.PriorityResource(env, capacity=2)

    def repair(number):
        come_h = env.now
        with bench.request(priority=RULES[rule](number, works_h[number])) as turn:
            yield turn
            yield env.timeout(works_h[number])
        left.append((env.now - come_h) / 8)

    def door():
        for number, gap_h in enumerate(gaps_h):
            yield env.timeout(gap_h)
            env.process(repair(number))

    env.process(door())
    env.run()
    return np.array(left)


# 1. Which rule has the shortest stay? A promise of 95 %, and no more runs than it needs (Kim & Nelson's procedure).
names = list(RULES)
found = kn(
    each(lambda rule, first, upto: np.array([days_in_the_shop(names[rule], r).mean() for r in range(first, upto)])),
    names,
    indifference=0.05,
    confidence=0.95,
    better="less",
)
print(f"{found.winner}: {found.means[names.index(found.winner)]:.2f} days; {found.promise}")
for one in found.out:
    print(f"  {one.system}: out after {one.n} replications, beaten by {one.by}")

# 2. One long run of it: the mean with an interval from batches, and what forbids to believe it.
for n in (2_000, 20_000):
    days = days_in_the_shop("first come first served", 0, n)
    mean = batch_means(days)
    doubts = "; ".join(flag.says for flag in flags(days)) or "no doubts"
    print(f"{n} repairs, first come first served: {mean.mean:.2f} +- {mean.half_width:.2f} days ({doubts})")

# 3. A scenario swept: points are a name and changes, jobs are replications of them, answers are figures.
points = [Point(f"{n} places", {"stations.drilling.buffer": n, "stations.painting.buffer": n}) for n in (0, 2, 5)]
answers = Answers(Source("serial_line", ("throughput_per_h",), changes={"run.horizon": "8 h"}), processes=1)
boards = answers.values([Job(p, r) for p in points for r in range(3)], [("throughput_per_h", "", "", "1/h")])
for point, per_h in zip(points, boards.reshape(len(points), -1)):
    print(f"{point.name} between machines: {per_h.mean():.1f} boards an hour")

"""Bucket brigades: where people hand over, and how much they make, from the log of a run.

Source: Bartholdi & Eisenstein 1996, A production line that balances itself, Operations Research 44(1); the numbers are
those of ``known_answers.json``.
"""

from __future__ import annotations

import json
from itertools import pairwise

import numpy as np
from known_answers.case import HERE
from recordings import reference

from opsim.engine import SIMPY
from opsim.engine.choice import able_to, runner_of
from opsim.laws.audit import audit
from opsim.log import FINISH
from opsim.plan import compile_plan
from opsim.scenario import read_scenarios
from opsim.subjects.lines.figures import HandOvers, hand_overs

WORK_S = 36_000.0
VELOCITIES = {"three": "[1, 2, 3]", "two": "[1, 1.5]", "four": "[0.8, 1, 1.2, 1.5]"}


def expected(variant: str) -> tuple[list[float], float]:
    """(hand-off positions, pieces in the time that pace 1 takes for one) that theory gives."""
    entries = json.loads(reference("known_answers.json").read_text())
    found = next(entry["expected"] for entry in entries if entry["name"].startswith("bucket brigade"))
    answer = found[VELOCITIES[variant]]
    return answer["handoffs"], answer["rate"]


def brigade(variant: str, engine: str = SIMPY) -> tuple[HandOvers, np.ndarray, tuple[int, ...]]:
    """(hand-overs, (n,) times of finishing in s, members) of a run of a variant, from its start."""
    plan = compile_plan(read_scenarios(HERE / "bucket_brigade.yaml", [variant])[variant])
    log = runner_of(able_to(engine, plan))(plan, 0)
    audit(log, plan)
    return hand_overs(log, plan, plan.crews[0]), log["end_s"][log["kind"] == FINISH], plan.crews[0].workers


def positions(found: HandOvers, members: tuple[int, ...]) -> list[np.ndarray]:
    """Of each pair of neighbours (n,) where they handed over, in the order of time."""
    return [found.position[(found.before == a) & (found.after == b)] for a, b in pairwise(members)]


def rates(finish_s: np.ndarray) -> np.ndarray:
    """(n - 1,) pieces in the time that pace 1 takes for one, from one finish to the next."""
    return WORK_S / np.diff(finish_s)


def told(variant: str, engine: str = SIMPY) -> bool:
    """Print theory beside the last hand-overs of a run; True where all agree to 1e-9."""
    handoffs, rate = expected(variant)
    found, finish_s, members = brigade(variant, engine)
    last = [float(position[-1]) for position in positions(found, members)]
    theory, seen = [*handoffs, rate], [*last, float(rates(finish_s)[-1])]
    worst = max(abs(one / other - 1) for one, other in zip(seen, theory, strict=True))
    shown = ", ".join(f"{one:.10f} of {other:.10f}" for one, other in zip(seen, theory))
    print(f"bucket_brigade/{variant}: hand-overs and rate {shown}", "" if worst <= 1e-9 else "does not hold")
    return worst <= 1e-9

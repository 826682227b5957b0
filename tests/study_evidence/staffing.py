"""What hiring luck is worth in ``tests/known_answers/staffing.yaml``, told apart from the run's own noise.

    PYTHONPATH=tests python -m study_evidence.staffing [WORKFORCES] [PROCESSES]

The oracle is the standard deviation of relative throughput over 3,000 crews, each with one run of 3,500 jobs: hiring
luck AND the noise of that run. Here the noise is told apart: staffing SD is without it. Of 3,500 jobs it is about 0.004
to 0.005, and adds less than 0.3 % to 0.082: far below what either side can see (the oracle's own error is 1.3 %, that
of 800 workforces 2.5 %).
"""

from __future__ import annotations

import sys
import time
from pathlib import Path

import numpy as np

from opsim.study.jobs import Answers, Point, Source
from opsim.study.labour import VarianceParts, variance_parts
from opsim.study.labour.interventions import jobs_of

FILE = Path(__file__).parent.parent / "known_answers" / "staffing.yaml"
EXPECTED = {"quarter": 0.082, "half": 0.112}
ORACLE_JOBS, WITHIN = 3500, 0.10
RATE = ("throughput_per_h", "", "", "1/h")


def split(
    variant: str,
    workforces: int,
    replications: int,
    processes: int | None = 1,
    horizon: str | None = None,
    design: str = "crossed",
) -> VarianceParts:
    """Parts of the variance of throughput times mean time; horizon : instead of 1400 s."""
    changes = {} if horizon is None else {"run.horizon": horizon}
    answers = Answers(Source(str(FILE), RATE[:1], changes=changes), processes=processes)
    jobs = jobs_of(Point(variant, {}, variant), workforces, replications, design)
    rates = answers.values(jobs, [RATE]) / 3600.0
    answers.close()
    return variance_parts(rates.reshape(workforces, replications), design)


def with_noise_of(parts: VarianceParts, jobs: float) -> float:
    """SD that a run of so many jobs would show: noise falls as 1 / jobs."""
    here = 1200.0 * parts.mean
    return float(np.sqrt(parts["staffing"].variance + parts["run"].variance * here / jobs))


def main(workforces: int = 800, processes: int = 2) -> int:
    """Print what was found; 1 where a claim does not hold."""
    wrong = 0
    for variant, expected in EXPECTED.items():
        begun = time.monotonic()
        parts = split(variant, workforces, 2, processes, design="nested")
        staffing, run = parts["staffing"], parts["run"]
        off = staffing.sd / expected - 1
        wrong += abs(off) > WITHIN
        print(f"{variant}: mean {parts.mean:.4f}")
        print(f"  staffing SD {staffing.sd:.4f} ({staffing.low_sd:.4f} to {staffing.high_sd:.4f}), oracle {expected}")
        print(f"  off by {100 * off:+.1f} % (allowed: {100 * WITHIN:.0f} %)")
        print(f"  run noise SD {run.sd:.4f} ({run.low_sd:.4f} to {run.high_sd:.4f}) in 1200 s")
        print(
            f"  together, as the oracle's runs of {ORACLE_JOBS} jobs show it: {with_noise_of(parts, ORACLE_JOBS):.4f}"
        )
        print(f"  {workforces} workforces x 2 runs in {time.monotonic() - begun:.0f} s on {processes} processes")
    return wrong


if __name__ == "__main__":
    sys.exit(main(*map(int, sys.argv[1:3])))

"""The variability budget of ``scenarios/staffing_luck.yaml``: do parts and interaction add up where each is estimated
from people and days of its own?

    PYTHONPATH=tests python -m study_evidence.budget [WORKFORCES] [PROCESSES]

Within one study they add up exactly, pair by pair. Here each part, the interaction and the whole have another seed, so
that the sum is a test.
"""

from __future__ import annotations

import sys

import numpy as np

from opsim.scenario.study_checks import Varied
from opsim.study.intervals import Interval
from opsim.study.jobs import Answers, Point, Source
from opsim.study.labour.budget import changes_off, difference_interval, sources_on
from opsim.study.labour.interventions import jobs_of

FILE, SEED, REPLICATIONS = "staffing_luck", 9000, 2
RATE = ("throughput_per_h", "", "", "1/h")


def main(workforces: int = 40, processes: int = 2) -> int:
    """Print what was found; 1 where the sum is beyond the intervals."""
    loaded = Varied.read(FILE).with_changes({})
    names = [source.name for source in sources_on(loaded)]

    def tables(number: int, *offs: list[str]) -> list[np.ndarray]:
        """(W, R) rates with some sources off, of the people and days of one seed."""
        answers = Answers(Source(FILE, RATE[:1], SEED + number), processes=processes)
        jobs = [
            jobs_of(Point("off", changes_off(loaded, off), None), workforces, REPLICATIONS, "nested") for off in offs
        ]
        rates = answers.values([job for some in jobs for job in some], [RATE]).reshape(len(offs), workforces, -1)
        answers.close()
        return list(rates)

    parts: dict[str, Interval] = {}
    for number, name in enumerate(names):
        full, off = tables(number, [], [name])
        parts[name] = difference_interval(off - full, full, crossed=False)
    full, all_off, *each = tables(len(names), [], names, *([name] for name in names))
    parts["what they do to each other"] = difference_interval(all_off - full - sum(e - full for e in each), full, False)
    full, all_off = tables(len(names) + 1, [], names)
    whole = difference_interval(all_off - full, full, crossed=False)
    for name, of in parts.items():
        print(f"{name:28s} {of.mean:+.2f} +/- {of.half_width:.2f}")
    total = sum(of.mean for of in parts.values())
    wide = float(np.sqrt(sum(of.half_width**2 for of in (*parts.values(), whole))))
    print(f"{'sum':28s} {total:+.2f}\n{'all of them':28s} {whole.mean:+.2f} +/- {whole.half_width:.2f}")
    print(f"apart by {total - whole.mean:+.2f}; allowed: {wide:.2f}")
    return int(abs(total - whole.mean) > wide)


if __name__ == "__main__":
    sys.exit(main(*map(int, sys.argv[1:3])))

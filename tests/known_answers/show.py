"""Prints theory beside simulation for every case, at the replications the files ask for: ``make known-answers``.

``python -m known_answers.show --engine fast`` has the fast engine simulate them; ``--no-audit`` leaves out
whether every run obeys all laws, which then takes most of the time.
"""

import argparse
import os
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

from known_answers import crews, emulated_staffing, staffing
from known_answers.cases import CASES, Case
from known_answers.simulate import simulate
from recordings import data_folder

from opsim.engine import ENGINES, SIMPY
from opsim.study.intervals import t_interval

MOST_OUTSIDE_95 = 4 / 46
"""Of the figures; one in twenty is expected."""


def main() -> int:
    """0 where theory holds: none outside the 99.9 % interval, at most 4 of 46 outside the 95 %, all precise enough."""
    parser = argparse.ArgumentParser(prog="known_answers.show", description=__doc__)
    parser.add_argument("--engine", choices=ENGINES, default=SIMPY)
    parser.add_argument("--no-audit", action="store_true", help="do not look whether every run obeys all laws")
    given = parser.parse_args()
    engine, audited = given.engine, not given.no_audit
    if not (data_folder() / "reference" / "known_answers.json").exists():
        print("needs reference/known_answers.json in ../shared/data or in $OPSIM_DATA", file=sys.stderr)
        return 2
    with TemporaryDirectory() as folder:
        print("fitting made motions of 300 people at three shares ...", file=sys.stderr, flush=True)
        emulated, mean_s = emulated_staffing.written(Path(folder), processes=os.cpu_count() or 1)
        asked = (*CASES, *staffing.CASES, *emulated)
        how = {"processes": os.cpu_count() or 1, "engine": engine, "audited": audited}
        runs = simulate(asked, done=_progress, **how)
    print(f"\n{'figure':42} {'theory':>10} {'simulated':>10} {'95 %':>8}  half-width  n")
    verdicts = [_line(case, runs[case.file, case.variant][case.kpi]) for case in CASES]
    outside = [sum(verdict == word for verdict in verdicts) for word in ("outside 95 %", "outside 99.9 %", "imprecise")]
    print(f"{len(CASES)} figures: {outside[0]} outside 95 %, {outside[1]} outside 99.9 %, {outside[2]} imprecise")
    staffed = [_staffing("staffing", v, staffing.rates(runs, v)) for v in staffing.EXPECTED]
    for case in emulated:
        rates = emulated_staffing.rates(runs, case, mean_s[case.variant])
        staffed.append(_staffing("staffing, emulated", case.variant, rates))
    staffed += [crews.told(variant, engine) for variant in crews.VELOCITIES]
    return int(outside[0] > MOST_OUTSIDE_95 * len(CASES) or any(outside[1:]) or not all(staffed))


def _staffing(name: str, variant: str, rates) -> bool:
    mean, sd = staffing.EXPECTED[variant]
    found, spread = float(rates.mean()), float(rates.std(ddof=1))
    holds = abs(found / mean - 1) <= 0.015 and (sd is None or abs(spread / sd - 1) <= 0.1)
    against = "" if sd is None else f" (of {sd})"
    print(f"{name}/{variant}: {found:.4f} of {mean}, SD over {len(rates)} workforces {spread:.4f}{against}", end=" ")
    print("" if holds else "does not hold")
    return holds


def _line(case: Case, values) -> str:
    narrow, wide, theory = t_interval(values, 0.95), t_interval(values, 0.999), case.answer()
    verdict = _verdict(theory, narrow, wide, case.most_half_width)
    relative = f"{100 * narrow.half_width / narrow.mean:5.2f} %" if narrow.mean else "-"
    figures = f"{theory:10.4f} {narrow.mean:10.4f} {narrow.half_width:8.4f}  {relative}  {narrow.n:5}"
    print(f"{case.name:42} {figures} {verdict}")
    return verdict


def _verdict(theory, narrow, wide, most_half_width: float) -> str:
    if narrow.half_width > most_half_width * narrow.mean:
        return "imprecise"
    if abs(theory - narrow.mean) <= 1e-6 * theory or narrow.low <= theory <= narrow.high:
        return ""
    return "outside 95 %" if wide.low <= theory <= wide.high else "outside 99.9 %"


def _progress(n: int, total: int) -> None:
    print(f"\r{n} of {total} replications", end="", file=sys.stderr, flush=True)


if __name__ == "__main__":
    sys.exit(main())

"""``python -m bench.peers [ROUNDS]``: every answer is checked, then all models take turns; ratios to SimPy by hand."""

import sys

from bench.peers.answers import LONG_RUN, long_run_error
from bench.peers.compare import (
    ENTRIES,
    GIVEN,
    MODELS,
    MOST_ERRORS,
    agree,
    by_themselves,
    exact,
    installed,
    jobs_per_cpu_s,
    runners,
)

ROUNDS = 5
SEEDS = range(101, 104)
"""Of the runs that are held against the long run before anything is timed."""


def main(rounds: int = ROUNDS) -> int:
    entrants, alone = runners(), by_themselves()
    for entry in ENTRIES:
        if not installed(entry.package):
            print(f"{entry.label}: {entry.package} is not installed, left out")
    wrong = [runner for runner in entrants if not _checked(runner)] + [one for one in alone if not _held(one)]
    if wrong:
        return 1
    print(f"{len(entrants)} models answer exactly, job by job; now {rounds} rounds, best of each", flush=True)
    entrants += alone
    for runner in entrants:
        if runner.luck != GIVEN:  # what sets itself up the first time is then there
            runner.run(0)
    speeds: dict = {(runner.model, runner.label): [] for runner in entrants}
    for seed in range(1, rounds + 1):
        for runner in entrants:
            speeds[runner.model, runner.label].append(jobs_per_cpu_s(runner, seed))
    _table(speeds)
    return 0


def _checked(runner) -> bool:
    found, wanted = exact(runner)
    if not agree(found, wanted):
        print(f"WRONG {runner.label}, {runner.variant}: found {found}, expected {wanted}")
    return agree(found, wanted)


def _held(runner) -> bool:
    """Of what draws for itself: three runs near the long run, each within so many standard errors."""
    found = [runner.run(seed) for seed in SEEDS]
    errors = max(long_run_error(runner.model, one) for one in found)
    told = ", ".join(f"{answer:.4g}" for _, answer in found)
    long_run = f"{LONG_RUN[runner.model]} in the long run, at most {errors:.1f} standard errors off"
    print(f"{'WRONG ' * (errors >= MOST_ERRORS)}{runner.label}, {runner.variant}, draws for itself: {told}; {long_run}")
    return errors < MOST_ERRORS


def _table(speeds: dict) -> None:
    print(
        f"\n{'model':6}{'simulator':14}{'jobs a CPU second':>18}{'spread':>8}{'CPU of SimPy by hand':>22}{'speed':>10}"
    )
    for model in MODELS:
        found = {label: ours for (of, label), ours in speeds.items() if of == model}
        by_hand = max(found["SimPy by hand"])
        for label, ours in found.items():
            best = max(ours)
            told = f"{best:18,.0f}{1 - min(ours) / best:8.0%}{by_hand / best:20.3f} x{best / by_hand:8.1f} x"
            print(f"{model:6}{label:14}{told}")
        if "cimba" in found:
            ahead = max(found["opsim fast"]) / max(found["cimba"])
            print(f"{model:6}opsim fast, event log on: {ahead:.2f} x the speed of cimba")
    for entry in ENTRIES:
        missing = [m for m in MODELS if m not in {variant.split("_")[0] for variant in entry.until_s}]
        if missing and installed(entry.package) and not entry.label.endswith("manned"):
            print(f"{entry.label}: no {', '.join(missing)}")


if __name__ == "__main__":
    sys.exit(main(*map(int, sys.argv[1:])))

"""``python -m bench.peers [ROUNDS]``: every answer is checked, then all models take turns; ratios to SimPy by hand."""

import sys

from bench.peers.compare import ENTRIES, MODELS, agree, exact, installed, jobs_per_cpu_s, runners

ROUNDS = 5


def main(rounds: int = ROUNDS) -> int:
    entrants = runners()
    for entry in ENTRIES:
        if not installed(entry.package):
            print(f"{entry.label}: {entry.package} is not installed, left out")
    wrong = [runner for runner in entrants if not _checked(runner)]
    if wrong:
        return 1
    print(f"{len(entrants)} models answer exactly, job by job; now {rounds} rounds, best of each", flush=True)
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


def _table(speeds: dict) -> None:
    print(f"\n{'model':6}{'simulator':16}{'jobs a CPU second':>18}{'spread':>8}{'CPU of SimPy by hand':>22}")
    for model in MODELS:
        by_hand = max(speeds[model, "SimPy by hand"])
        for (of, label), found in speeds.items():
            if of == model:
                best = max(found)
                print(f"{model:6}{label:16}{best:18,.0f}{1 - min(found) / best:8.0%}{by_hand / best:18.2f} x")
    for entry in ENTRIES:
        missing = [m for m in MODELS if m not in {variant.split("_")[0] for variant in entry.until_s}]
        if missing and installed(entry.package) and not entry.label.endswith("manned"):
            print(f"{entry.label}: no {', '.join(missing)}")


if __name__ == "__main__":
    sys.exit(main(*map(int, sys.argv[1:])))

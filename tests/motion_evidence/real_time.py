"""Prints how drawn movements stand beside recorded ones in real time, class by class: ``make real-time-evidence``."""

from __future__ import annotations

import argparse
import json
import os
import sys
import time
import traceback
from collections.abc import Iterator, Mapping
from concurrent.futures import ProcessPoolExecutor, as_completed
from multiprocessing import get_context
from pathlib import Path

import numpy as np
from motion_evidence.real_time_bounds import PAPER, Row, failures, pooled_coverage
from motion_evidence.real_time_rows import CLASSES, held_out, in_sample, left_out, path_of, people_of, postures

TWO, THREE = "{:.2f}", "{:.3f}"
TABLES: dict[str, tuple[str, tuple[tuple[str, str, str], ...]]] = {
    "all": (
        "Fitted on all: share with a joint over 1.1 x the fastest recorded (beside it that of left-out recordings and\n"
        "people), peak jerk and median peak speed over recorded; encode -> decode: jerk over recorded, error in mm to\n"
        "rigid bones and to what was seen, area under the curve of the classifier",
        (
            ("n", "n", "{:.0f}"),
            ("fast known", "too_fast_known", THREE),
            ("new", "too_fast_new", THREE),
            ("left out", "fast_left_out", THREE),
            ("people", "fast_people", THREE),
            ("jerk known", "jerk_ratio_known", TWO),
            ("new", "jerk_ratio_new", TWO),
            ("speed known", "speed_ratio_known", TWO),
            ("new", "speed_ratio_new", TWO),
            ("dec jerk", "decoded_jerk", TWO),
            ("dec mm", "decoded_mm", "{:.1f}"),
            ("seen mm", "decoded_seen_mm", "{:.1f}"),
            ("dec AUC", "decoded_auc", TWO),
        ),
    ),
    "feet": (
        "Feet: wander of a planted foot and slide of a planted joint (cm), depth in the floor (mm), share of the time\n"
        "with the centre of mass off the feet, share of the time with a foot down; as seen by the cameras, recorded\n"
        "with rigid bones hung from the pelvis (which lifts the feet of a squat), known and new people",
        tuple(
            (f"{heading} {who[:3]}", f"{name}_{who}", form)
            for heading, name, form in (
                ("wander", "wander_cm", TWO),
                ("slide", "slide_cm", TWO),
                ("sunk", "sunk_mm", "{:.1f}"),
                ("off", "unsupported", TWO),
                ("down", "planted", TWO),
            )
            for who in ("seen", "recorded", "known", "new")
        ),
    ),
    "halves": (
        "Fitted on half, against the other: energies of places (mm) and speeds (mm/s) of draws and of the halves\n"
        "themselves, area under the curve of the classifier for both",
        (
            ("splits", "splits", "{:.0f}"),
            ("places", "places_drawn", "{:.1f}"),
            ("halves", "places_halves", "{:.1f}"),
            ("ratio", "places_ratio", TWO),
            ("speeds", "speeds_drawn", "{:.1f}"),
            ("halves", "speeds_halves", "{:.1f}"),
            ("ratio", "speeds_ratio", TWO),
            ("AUC", "auc_drawn", TWO),
            ("halves", "auc_halves", TWO),
        ),
    ),
    "postures": (
        "Postures on the common clock, fitted on half: energy (unbiased, of a sample with everybody in it) beside the\n"
        "paper's scheme, DISCO, novelty",
        (
            ("energy", "energy_drawn", THREE),
            ("paper", "energy_paper", THREE),
            ("ratio", "energy_ratio", TWO),
            ("p", "p_drawn", TWO),
            ("p paper", "p_paper", TWO),
            ("novelty", "novelty_drawn", TWO),
            ("paper", "novelty_paper", TWO),
        ),
    ),
    "people": (
        "New people: share of left-out people's repetitions inside the 50 and 90 % intervals of duration, and of\n"
        "where each bone points",
        (
            ("people", "people_left_out", "{:.0f}"),
            ("time 50", "duration_50", TWO),
            ("90", "duration_90", TWO),
            ("posture 50", "posture_50", TWO),
            ("90", "posture_90", TWO),
        ),
    ),
}
PARTS = ("all", "halves", "postures", "people")
RATIOS = {
    "places_ratio": ("places_drawn", "places_halves"),
    "speeds_ratio": ("speeds_drawn", "speeds_halves"),
    "energy_ratio": ("energy_drawn", "energy_paper"),
}
Job = tuple[str, str, int | str, int]


def main(arguments: list[str] | None = None) -> int:
    """0 where every bound holds, 1 where one does not, 2 where the recordings are not at hand."""
    options = _options(arguments)
    absent = [task for task in options.classes if not path_of(task).exists()]
    if absent:
        print(f"needs motion/{absent[0]}.npz in ../shared/data or in $OPSIM_DATA", file=sys.stderr)
        return 2
    found, refused = measured(_jobs(options))
    table = figures(found, options.classes)
    print("\n".join(lines(table, options.parts)))
    if options.out is not None:
        options.out.write_text(json.dumps(table, indent=1))
    before = {} if options.before is None else json.loads(options.before.read_text())
    wrong = failures(table, refused, before)
    print("every bound holds" if not wrong else "does not hold:\n  " + "\n  ".join(wrong))
    return int(bool(wrong))


def measure(job: Job) -> Row:
    part, task, which, n = job
    if part == "all":
        return in_sample(task, n)
    if part == "people":
        return left_out(task, str(which))
    return {"halves": held_out, "postures": postures}[part](task, int(which), n)


def measured(jobs: list[Job]) -> tuple[dict[Job, Row], dict[str, str]]:
    """The rows of the jobs, made in two processes, and what was refused; progress with the time left on stderr."""
    start_s, made, refused = time.monotonic(), {}, {}
    with ProcessPoolExecutor(min(2, os.cpu_count() or 1), mp_context=get_context("spawn")) as pool:
        running = {pool.submit(measure, job): job for job in jobs}
        for done, future in enumerate(as_completed(running), 1):
            job = running[future]
            try:
                made[job] = future.result()
            except ValueError as error:
                refused[f"{job[1]}, {job[0]} {job[2]}"] = "".join(traceback.format_exception_only(error)).strip()
            left_s = (time.monotonic() - start_s) / done * (len(jobs) - done)
            print(f"\r{done} of {len(jobs)} steps, {left_s:4.0f} s left ", end="", file=sys.stderr, flush=True)
    print(file=sys.stderr)
    return made, refused


def figures(found: Mapping[Job, Row], classes: list[str]) -> dict[str, Row]:
    """Class -> its figures: means over splits and people, of what is known."""
    table: dict[str, Row] = {}
    for task in classes:
        row: Row = {}
        for part in PARTS:
            rows = [found[job] for job in sorted(found, key=str) if job[:2] == (part, task)]
            for name in dict.fromkeys(name for one in rows for name in one):
                values = np.array([one[name] for one in rows if np.isfinite(one.get(name, np.nan))])
                row |= {name: float(values.mean())} if len(values) else {}
            if rows and part in ("halves", "people"):
                row["splits" if part == "halves" else "people_left_out"] = len(rows)
        row |= {name: max(row[a], 0.0) / row[b] for name, (a, b) in RATIOS.items() if a in row and row.get(b, 0) > 0}
        table[task] = row
    return table


def lines(table: Mapping[str, Row], parts: list[str]) -> Iterator[str]:
    """The tables, and what is said over all classes."""
    for name, (title, columns) in TABLES.items():
        if ("all" if name == "feet" else name) not in parts:
            continue
        yield title
        yield f"{'class':26}" + "".join(f"{heading:>12}" for heading, _, _ in columns)
        for task, row in table.items():
            cells = (form.format(row[key]) if key in row else "-" for _, key, form in columns)
            yield f"{task:26}" + "".join(f"{cell:>12}" for cell in cells)
        yield ""
    for name, share in pooled_coverage(table).items():
        yield f"over all people, {name.replace('_', ' ')} % interval holds {share:.3f}"
    ratios = [row["energy_ratio"] for row in table.values() if "energy_ratio" in row]
    if ratios:
        yield f"energy at most {PAPER} of the paper's in {sum(r <= PAPER for r in ratios)} of {len(ratios)} classes"
    left = int(sum(row.get("people_left_out", 0) for row in table.values()))
    if left:
        yield f"fits without one person: {left} run"


def _jobs(options: argparse.Namespace) -> list[Job]:
    jobs: list[Job] = []
    for task in options.classes:
        jobs += [("all", task, 0, options.draws)] * ("all" in options.parts)
        if "halves" in options.parts:
            jobs += [("halves", task, split, options.each) for split in range(options.splits)]
        if "postures" in options.parts:
            jobs += [("postures", task, split, options.draws) for split in range(options.posture_splits)]
        if "people" in options.parts:
            jobs += [("people", task, name, 0) for name in people_of(task)]
    return jobs


def _options(arguments: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m motion_evidence.real_time", description=__doc__)
    parser.add_argument("classes", nargs="*", metavar="CLASS", help=", ".join(CLASSES))
    parser.add_argument("--parts", nargs="+", choices=PARTS, default=list(PARTS))
    parser.add_argument("--splits", type=int, default=20, help="halves of the recordings")
    parser.add_argument("--posture-splits", type=int, default=5, help="halves judged on the common clock")
    parser.add_argument("--draws", type=int, default=400, help="draws of known and of new people each")
    parser.add_argument("--each", type=int, default=30, help="draws for each left-out recording")
    parser.add_argument("-o", "--out", type=Path, help="a JSON file for the figures")
    parser.add_argument("--before", type=Path, help="figures of an earlier run, than which novelty must not be worse")
    options = parser.parse_args(arguments)
    unknown = [name for name in options.classes if name not in CLASSES]
    if unknown:
        parser.error(f"no class {unknown[0]!r}; known: {', '.join(CLASSES)}")
    options.classes = options.classes or list(CLASSES)
    return options


if __name__ == "__main__":
    sys.exit(main())

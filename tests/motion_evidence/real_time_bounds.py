"""The bounds that drawn movements are to keep in real time, and which of them do not hold."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from emulator.judge.coverage import QUANTITIES

Row = dict[str, float]
FAST = {"known": 0.02, "new": 0.05}
JERK = {"known": 1.3, "new": 1.5}
SPEED_OFF = 0.1
DECODED_JERK, DECODED_MM, DECODED_MM_WALKING = (0.9, 1.1), 10.0, 25.0
WALKING = ("bandai2_walk", "bandai2_walk_turn_left", "hdm05_jog_circle", "hdm05_sneak_2steps")
PAPER = 0.25
AUC_DECODED, AUC_DRAWN = 0.6, 0.75
FOOT_OFF, FOOT_OFF_CM, MORE_SUNK_MM, MORE_UNSUPPORTED = 0.2, 0.2, 5.0, 0.03
"""A wander is as recorded within a fifth, or within 2 mm where feet hardly move."""
COVERAGE = {50: (0.45, 0.55), 90: (0.87, 0.93)}
CLASSES_OF_15 = {"too fast": 13, "energies": 13, "classifier": 10}
NOVELTY_ROOM, P_ROOM = 0.1, 0.1
"""Worse than before from so much on."""


def share_needed(kind: str, n_classes: int) -> int:
    """How many of ``n_classes`` must keep the bound, of all 15 those of the issue."""
    return int(np.ceil(CLASSES_OF_15[kind] / 15 * n_classes - 1e-9))


def failures(table: Mapping[str, Row], refused: Mapping[str, str], before: Mapping[str, Row]) -> list[str]:
    """All that does not hold, in words. table, before : class -> its figures, of now and of an earlier run."""
    found = [words for task, row in table.items() for words in _of_class(task, row)]
    found += [f"{who}: refused: {why}" for who, why in refused.items()]
    for kind, check in (("too fast", _fast), ("energies", _energies), ("classifier", _told_apart)):
        asked = {task: check(row) for task, row in table.items() if check(row) is not None}
        failing = [f"{task} ({words})" for task, words in asked.items() if words]
        if len(asked) - len(failing) < share_needed(kind, len(asked)):
            kept = f"holds in {len(asked) - len(failing)} of {len(asked)} classes, not in"
            found.append(f"{kind}: {kept} {', '.join(failing)}")
    return found + list(_coverage(table)) + list(_worse(table, before))


def _of_class(task: str, row: Row) -> Iterator[str]:
    for who in ("known", "new"):
        if row.get(f"jerk_ratio_{who}", 0) > JERK[who]:
            yield f"{task}: peak jerk of {who} people {row[f'jerk_ratio_{who}']:.2f} x recorded"
        for part in ("wander_cm", "slide_cm"):
            ours, theirs = row.get(f"{part}_{who}"), row.get(f"{part}_recorded")
            if ours is not None and theirs is not None and abs(ours - theirs) > max(FOOT_OFF * theirs, FOOT_OFF_CM):
                yield f"{task}: {part.removesuffix('_cm')} of {who} people's feet {ours:.1f} cm, recorded {theirs:.1f}"
        if row.get(f"sunk_mm_{who}", 0) > row.get("sunk_mm_recorded", 0) + MORE_SUNK_MM:
            yield f"{task}: {who} people {row[f'sunk_mm_{who}']:.0f} mm in the floor, {row['sunk_mm_recorded']:.0f}"
        if row.get(f"unsupported_{who}", 0) > row.get("unsupported_recorded", 0) + MORE_UNSUPPORTED:
            yield f"{task}: {who} off their feet {row[f'unsupported_{who}']:.2f}, {row['unsupported_recorded']:.2f}"
    if abs(row.get("speed_ratio_known", 1) - 1) > SPEED_OFF:
        yield f"{task}: median peak speed {row['speed_ratio_known']:.2f} x recorded"
    jerk, most_mm = row.get("decoded_jerk", 1.0), DECODED_MM_WALKING if task in WALKING else DECODED_MM
    if not DECODED_JERK[0] <= jerk <= DECODED_JERK[1]:
        yield f"{task}: jerk of encode -> decode {jerk:.2f} x recorded"
    if row.get("decoded_mm", 0) > most_mm:
        yield f"{task}: encode -> decode is {row['decoded_mm']:.0f} mm off"


def _fast(row: Row) -> str | None:
    if "too_fast_known" not in row:
        return None
    shares = {who: row[f"too_fast_{who}"] for who in FAST}
    return ", ".join(f"{who} {share:.3f}" for who, share in shares.items() if share > FAST[who])


def _energies(row: Row) -> str | None:
    if "places_drawn" not in row:
        return None
    ratios = {name: row[f"{name}_drawn"] / row[f"{name}_halves"] for name in ("places", "speeds")}
    return ", ".join(f"{name} {ratio:.2f}" for name, ratio in ratios.items() if ratio > 1)


def _told_apart(row: Row) -> str | None:
    areas = [("decoded", "decoded_auc", AUC_DECODED), ("drawn", "auc_drawn", AUC_DRAWN)]
    if not any(name in row for _, name, _ in areas):
        return None
    return ", ".join(f"{word} {row[name]:.2f}" for word, name, most in areas if row.get(name, 0) > most)


def _coverage(table: Mapping[str, Row]) -> Iterator[str]:
    for name, share in pooled_coverage(table).items():
        low, high = COVERAGE[int(name.rsplit("_", 1)[1])]
        if not low <= share <= high:
            yield f"new people's interval {name.replace('_', ' ')} %: holds {share:.2f}, expected {low} to {high}"


def pooled_coverage(table: Mapping[str, Row]) -> Row:
    """Over the people of all classes."""
    rows = [(row["people_left_out"], row) for row in table.values() if "people_left_out" in row]
    names = [f"{quantity}_{level}" for quantity in QUANTITIES for level in COVERAGE]
    return {name: float(np.average([r[name] for _, r in rows], weights=[n for n, _ in rows])) for name in names if rows}


def _worse(table: Mapping[str, Row], before: Mapping[str, Row]) -> Iterator[str]:
    """Novelty or DISCO worse than in the run before."""
    for task, row in table.items():
        was = before.get(task, {})
        for name, room in (("novelty_drawn", NOVELTY_ROOM), ("p_drawn", P_ROOM)):
            if name in row and name in was:
                worse = (
                    abs(row[name] - 1) > abs(was[name] - 1) + room
                    if "novelty" in name
                    else row[name] < was[name] - room
                )
                if worse and not (name == "p_drawn" and row[name] > 0.05):
                    yield f"{task}: {name.removesuffix('_drawn')} {row[name]:.2f}, before {was[name]:.2f}"

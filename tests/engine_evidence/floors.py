"""Random floors by number, 0 to 999: together they use every block, option and rule of the language.

``floor_text(number)`` is a scenario as YAML, the same for ever; times are whole seconds more often than not, so that
ties are real. A floor that the language refuses, that locks or starves, or in which nothing ties is drawn again: which
attempt is a good one stands in ``attempts.txt``. ``make made-floors`` looks at all of them, and where one is good no
more (the language has changed, or a recipe) seeks the first that is.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cache
from itertools import count
from pathlib import Path
from typing import Any

import yaml
from checked_floors import plan_of
from choices import Lots
from engine_evidence.coverage import blocks_of, shown_by
from engine_evidence.more_material import MATERIAL
from engine_evidence.more_people import PEOPLE_MORE
from engine_evidence.more_stations import STATIONS_MORE
from engine_evidence.more_times import TIMES, Values
from engine_evidence.targets import TARGETS
from engine_evidence.ties import contested_ties
from made.blocks import BLOCKS, floor_with
from made.brigades import scenario as brigade_text
from made.crews import CREWS
from made.floors import text_of
from made.lines import line_scenario
from made.people_blocks import ALWAYS, PEOPLE, people_floor_with

from opsim.engine.floor.run import run_plan
from opsim.log import FINISH
from opsim.plan import Plan
from opsim.problems import ScenarioError

N_FLOORS = 1000
ENOUGH_JOBS, MOST_ROWS = 20, 9000
ATTEMPTS = Path(__file__).with_name("attempts.txt")
MORE: dict[str, Callable[[Any, Values], None]] = {**STATIONS_MORE, **PEOPLE_MORE, **MATERIAL, **TIMES}
"""What is put on a floor as values, in this order."""
SELDOM = (
    "choice",
    "sequence",
    "schedule",
    "at_once",
    "kanban",
    "quality",
    "conveyor",
    "blocking_before",
    "setup",
    "assembly",
    "assembly",
    "kanban",
)
SELDOM_PEOPLE = (
    "zones",
    "choice_of_work",
    "overtime",
    "floaters",
    "rotation",
    "work_sharing",
    "station_hours",
    "rotation",
    "rotation",
    "limited",
)
SELDOM_MORE = (
    *(4 * ("stops",)),
    *(3 * ("setups", "parallel", "flow_rules", "distributions", "learning")),
    *(2 * ("left_by_rule", "open_orders", "opening", "exposure", "by_state", "variability", "fatigue", "gaps")),
    *("muscles", "emulated", "recorded_times", "redrawn", "held_tools", "looks", "homing", "heavy_lots"),
    *("family_batches", "families", "rules_of_choice", "long_belts", "team_runs", "distance", "away"),
)
SHOWN = ("log: ", "cause: ", "act: ")
"""How words begin that only a log can show."""
WHERE = {"turns": "rotations", "called_to_lines": "lines", "store_cards": "stores", "homing": "transporters"}
"""What is put on every other floor that has such a section."""


def floor_text(number: int) -> str:
    """The YAML of a floor."""
    return text_of(_drawn(number, attempt_of(number)))


def replication_of(number: int) -> int:
    """The replication in which a floor is run: not always the first, whose workforce a redrawn one is as well."""
    return number % 3


def good(plan: Plan, replication: int, word: str = "") -> bool:
    """Whether a floor is worth a comparison: it goes on to the end, something ties in it, and it shows a word."""
    log = run_plan(plan, replication)
    ended_s = log.of(FINISH)["end_s"]
    if len(ended_s) < ENOUGH_JOBS or ended_s.max() < 0.6 * plan.horizon_s or len(log) > MOST_ROWS:
        return False
    return contested_ties(plan, log) > 0 and (not word or word in {*blocks_of(plan), *shown_by(plan, log)})


def attempt_of(number: int) -> int:
    """A good attempt: the one that was written down, else the first."""
    known = _written()
    return known[number] if number < len(known) else sought(number)


def sought(number: int) -> int:
    """The first good attempt, by running one after the other."""
    return next(attempt for attempt in count() if _is_good(number, attempt))


def kept(number: int) -> int:
    """The attempt that was written down where it still is good, else the first good one."""
    attempt = attempt_of(number)
    return attempt if _is_good(number, attempt) else sought(number)


def _is_good(number: int, attempt: int) -> bool:
    try:
        plan = plan_of(text_of(_drawn(number, attempt)))
    except ScenarioError:
        return False
    word = TARGETS[number % len(TARGETS)][0]
    if word and not word.startswith(SHOWN) and word not in blocks_of(plan):
        return False
    return good(plan, replication_of(number), word)


@cache
def _written() -> tuple[int, ...]:
    return tuple(map(int, ATTEMPTS.read_text().split())) if ATTEMPTS.exists() else ()


def _drawn(number: int, attempt: int) -> Values:
    pick = Lots(1000 * number + attempt)
    _, kind, asked = TARGETS[number % len(TARGETS)]
    kind = kind or pick.one_of(_OFTEN)
    values = _KINDS[kind](pick, asked)
    wanted = [*asked, *dict.fromkeys(pick.shuffled([*MORE, *SELDOM_MORE]))][: len(asked) + pick.whole(1, 4)]
    wanted += [name for name, section in WHERE.items() if section in values and pick.whole(0, 1)]
    for name, put in MORE.items():
        if name in wanted:
            put(pick, values)
    return values


def _of_blocks(pick, asked: Sequence[str]) -> Values:
    """Blocks of material and stations, for twenty minutes."""
    return floor_with(pick, [*asked, *_some(pick, [*BLOCKS, *SELDOM], 2, 7)])


def _of_people(pick, asked: Sequence[str]) -> Values:
    """Shifts, breaks, who goes where, and a few of the others, for an hour."""
    mine = [name for name in (*PEOPLE, *CREWS, *SELDOM_PEOPLE) if name not in ALWAYS]
    return people_floor_with(pick, [*asked, *ALWAYS, *_some(pick, mine, 2, 5), *_some(pick, [*BLOCKS], 0, 3)])


def _of_lines(pick, _asked: Sequence[str]) -> Values:
    """A paced line, for half an hour."""
    return line_scenario(pick.whole(0, 10**6))


def _of_crews(pick, _asked: Sequence[str]) -> Values:
    """A crew on a line, for forty minutes."""
    return yaml.safe_load(brigade_text(pick.whole(0, 10**6)))


def _some(pick, names: Sequence[str], least: int, most: int) -> list[str]:
    """Some of them, those that stand there twice more often."""
    return list(dict.fromkeys(pick.shuffled(names)))[: pick.whole(least, most)]


_KINDS = {"blocks": _of_blocks, "people": _of_people, "lines": _of_lines, "crews": _of_crews}
_OFTEN = (*4 * ("blocks",), *4 * ("people",), "lines", "crews")


def main() -> None:
    """Look at all floors, and write their attempts down."""
    from concurrent.futures import ProcessPoolExecutor

    from rich.console import Console
    from rich.progress import track

    with ProcessPoolExecutor(2) as pool:
        each = pool.map(kept, range(N_FLOORS), chunksize=10)
        found = list(track(each, "floors drawn", N_FLOORS, console=Console(stderr=True)))
    rows = [" ".join(map(str, found[start : start + 25])) for start in range(0, N_FLOORS, 25)]
    ATTEMPTS.write_text("\n".join(rows) + "\n")


if __name__ == "__main__":
    main()

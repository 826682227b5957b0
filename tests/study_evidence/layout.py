"""Must-show: from the median of 200 random layouts to a proposal that is better in walking and in throughput.

``PYTHONPATH=tests python -m study_evidence.layout`` draws 200 layouts of the shipped eight-station cell from a named
stream, simulates each, shows that the shipped layout is the median one by walking, and runs the study from it.
``--table`` prints the layout to ship, after a change of the cell.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from opsim.problems import natural_key
from opsim.scenario.schema.studies import LayoutStudy
from opsim.scenario.study_checks import Varied
from opsim.streams import stream
from opsim.study.jobs import Answers, Job, Point, Source
from opsim.study.layout.study import LayoutAsked, LayoutFound, asked_of, study_layout

FILE, LAYOUTS, EACH = "eight_station_cell", 200, 2
KPIS = ("walked_m", "throughput_per_h")


@dataclass(frozen=True)
class Drawn:
    """A random layout: the place of each station, metres that all people walk in an hour, parts an hour."""

    at: Mapping[str, str]
    walked_m_per_h: float
    parts_per_h: float


def random_layout(seed: int, number: int, stations: list[str], places: list[str]) -> dict[str, str]:
    """Every way to put the stations on the places has the same chance; both in natural order."""
    order = stream(seed, 0, "random layout", number).permutation(len(places))
    return {station: places[order[rank]] for rank, station in enumerate(stations)}


def drawn(layouts: Sequence[int] = range(LAYOUTS), each: int = EACH, processes: int | None = None) -> list[Drawn]:
    """Random layouts of some numbers, simulated on the same random numbers, in their order."""
    scenario = Varied.read(FILE).with_changes({}).scenario
    stations, places = (sorted(names, key=natural_key) for names in (scenario.stations, scenario.layout.places))
    ats = [random_layout(scenario.run.seed, number, stations, places) for number in layouts]
    points = [Point(f"random {k}", {f"stations.{s}.at": p for s, p in at.items()}) for k, at in enumerate(ats)]
    answers = Answers(Source(FILE, KPIS), processes=processes)
    jobs = [Job(point, number) for point in points for number in range(each)]
    keys = [key for key in answers.keys(jobs) if key[0] == "walked_m" or key[:2] == ("throughput_per_h", "")]
    values = answers.values(jobs, keys).reshape(len(ats), each, len(keys)).mean(axis=1)
    walked = [n for n, key in enumerate(keys) if key[0] == "walked_m"]
    hours = (scenario.run.horizon_s - scenario.run.warm_up_s) / 3600
    parts = values[:, [n for n in range(len(keys)) if n not in walked]].sum(axis=1)
    return [Drawn(at, float(m), float(n)) for at, m, n in zip(ats, values[:, walked].sum(axis=1) / hours, parts)]


def median(layouts: list[Drawn]) -> Drawn:
    """The lower of the two in the middle by walking; of equal ones the first drawn."""
    return sorted(layouts, key=lambda one: one.walked_m_per_h)[(len(layouts) - 1) // 2]


def shipped() -> dict[str, str]:
    """The place of each station in the shipped file."""
    return {name: one.at for name, one in Varied.read(FILE).with_changes({}).scenario.stations.items()}


def study(proposals: int = 5, replications: int = 20, processes: int | None = None) -> LayoutFound:
    """The study of the shipped cell."""
    asked = asked_for({"proposals": proposals, "replications": replications})
    return study_layout(asked, Answers(Source(FILE, asked.kept), processes=processes))


def asked_for(block: dict) -> LayoutAsked:
    """What is asked of the shipped cell."""
    varied = Varied.read(FILE)
    return asked_of(varied, varied.with_changes({}), LayoutStudy.model_validate(block), None)


def main() -> None:
    layouts = drawn()
    middle = median(layouts)
    if "--table" in sys.argv:
        print(f"number {layouts.index(middle)}")
        print("\n".join(f"{station}: {place}" for station, place in middle.at.items()))
        return
    walked = np.array([one.walked_m_per_h for one in layouts])
    parts = np.array([one.parts_per_h for one in layouts])
    print(f"{LAYOUTS} random layouts: {walked.min():.0f} to {walked.max():.0f} m/h, median {np.median(walked):.0f} m/h")
    print(f"the shipped one is the median: {middle.at == shipped()}, {middle.walked_m_per_h:.0f} m/h, ", end="")
    print(f"{middle.parts_per_h:.1f} parts/h (more than {100 * np.mean(parts < middle.parts_per_h):.0f} % of them)")
    found = study()
    for measure, one in found.fresh.items():
        low, high = one.difference.low, one.difference.high
        print(f"fresh numbers: {measure} {one.now.mean:.3f} -> {one.then.mean:.3f}, by {low:.3f} to {high:.3f}")
    assert found.taken is not None and middle.at == shipped()
    assert found.fresh["best"].difference.low > 0 > found.fresh["walked_m_per_h"].difference.high


if __name__ == "__main__":
    main()

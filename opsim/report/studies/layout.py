"""A layout study as a page and as one screen: what to move, both diagrams, the layouts simulated, the flows."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from opsim.kpi.catalogue import AskedFigure
from opsim.problems import enumerated
from opsim.report.numbers import ABSENT, digits, half_digits, is_number, kpi_name, scale_of
from opsim.report.page import StudyPage, StudySection, Table
from opsim.report.studies.layout_chart import Drawing, Line, layout_pictures
from opsim.report.studies.layout_sentences import NOT_MEASURED, answer, figure_unit, why_not_measured
from opsim.study.layout.evaluate import BEST, EXPOSURE, WALKED, Against, Flow, Flows
from opsim.study.layout.moves import Candidate, override_text
from opsim.study.layout.study import LayoutFound, known_mean, moved_stations, said

ON_SCREEN = 3
MOST_LINES = 60
"""Lines drawn: what is thinner would not be seen."""


def layout_page(found: LayoutFound) -> StudyPage:
    """What came out of ``study_layout``, told."""
    sections = [_pictures(found), *_layouts(found), *_override(found), *_flows(found)]
    return StudyPage(found.asked.floor.scenario.name, "layout", answer(found), sections, list(_words(found)))


def _pictures(found: LayoutFound) -> StudySection:
    now = _drawing(found, found.flows, None)
    then = [] if found.flows_then is None else [_drawing(found, found.flows_then, found.taken)]
    sentences = [
        "Boxes are stations at their places, to scale; dashed boxes are free places. A line is as thick as people go "
        "that way, both ways together; numbers are trips an hour."
    ]
    if then:
        sentences.append("Both floors and their lines have one scale. Filled boxes are stations that were moved.")
    if any(line.driven for one in (now, *then) for line in one.lines):
        sentences.append("Broken lines are drives of vehicles, drawn between the ends of their way.")
    title = "Who goes where, now and then" if then else "Who goes where"
    return StudySection(title, sentences, picture=layout_pictures([now, *then]))


def _drawing(found: LayoutFound, flows: Flows, one: Candidate | None) -> Drawing:
    floor = found.asked.floor
    at = floor.at if one is None else one.at
    names: dict[str, list[str]] = {}
    for station, place in at.items():
        names.setdefault(place, []).append(station)
    moved = [] if one is None else [*moved_stations(floor.at, one), *one.added]
    places = floor.places if one is None else {**floor.places, **one.moved}
    lines = [Line(flow.start, flow.end, flow.trips_per_h) for flow in flows.largest_first()[:MOST_LINES]]
    lines += [Line(f.start, f.end, f.trips_per_h, True) for f in flows.largest_first(of=flows.driven)[:MOST_LINES]]
    on_ways = floor.scenario.layout.distance == "paths"
    passed = {(line.start, line.end): flows.ways.way(line.start, line.end) for line in lines} if on_ways else {}
    title = "Now" if one is None else f"Then ({one.name})"
    return Drawing(
        f"{title}: {_km(flows.walked_m_per_h)} walked an hour",
        places,
        {place: ", ".join(stations) for place, stations in names.items()},
        lines,
        floor.scenario.layout.distance,
        frozenset(at[station] for station in moved) | frozenset(() if one is None else one.moved),
        {place: " ".join(words[0].split()[-1:]) for place, words in floor.others_at.items()},
        passed,
    )


def _layouts(found: LayoutFound) -> Iterator[StudySection]:
    if not found.candidates:
        return
    columns = ["layout", "what changes", "walked m/h", "walking", _column(found.asked.best)]
    if found.asked.exposure is not None:
        columns.append(f"{_column(found.asked.exposure)} *")
    rows = [_row(found, None), *(_row(found, one) for one in found.candidates)]
    sentences = []
    if found.asked.exposure is not None:
        sentences.append(f"* of {found.asked.exposure.subject or 'the worker who has most of it'}.")
        if any(row[-1] == NOT_MEASURED for row in rows):
            sentences.append(f"{NOT_MEASURED[:1].upper()}{NOT_MEASURED[1:]}: {why_not_measured(found)}.")
    if any(cell.endswith("?") for row in rows for cell in row):
        sentences.append("?: not told from no difference.")
    title = f"Layouts, each in the same {found.asked.replications} replications"
    yield StudySection(title, [" ".join(sentences)] if sentences else [], Table(columns, rows, words=2), on_screen=True)
    yield StudySection("Where the stations stand", list(_reach(found)), _standing(found))


def _reach(found: LayoutFound) -> Iterator[str]:
    """How good the proposals are as far as today's trips go."""
    made = found.proposals
    if made is not None:
        how = (
            f"all {made.tried:,} ways to place the stations were tried"
            if made.exact
            else "there are too many ways to try all, so there may be a shorter one"
        )
        yield f"Proposals shorten today's trips from {made.now_m_per_h:,.0f} to {made.best_m_per_h:,.0f} m/h; {how}."


def _standing(found: LayoutFound) -> Table:
    stations = dict.fromkeys([*found.asked.floor.at, *(name for one in found.candidates for name in one.added)])
    layouts = [found.asked.floor.at, *(one.at for one in found.candidates)]
    rows = [[station, *(at.get(station, "") for at in layouts)] for station in stations]
    columns = ["station", "now", *(one.name for one in found.candidates)]
    return Table(columns, rows, words=len(columns))


def _column(asked: AskedFigure) -> str:
    word = scale_of(figure_unit(asked.kpi), None)[1]
    return f"{kpi_name(asked.kpi)}{f', {word}' if word else ''}"


def _row(found: LayoutFound, one: Candidate | None) -> list[str]:
    figures = [(BEST, found.asked.best), *([(EXPOSURE, found.asked.exposure)] if found.asked.exposure else [])]
    factors = [(measure, scale_of(figure_unit(asked.kpi), None)[0]) for measure, asked in figures]
    if one is None:
        present = [_present(known_mean(found.now[measure]) * factor) for measure, factor in factors]
        return ["now", "", _whole_metres(known_mean(found.now[WALKED])), "", *present]
    of, what = found.compared[one.name], said(found.asked.floor.at, one, brief=True)
    name = one.name if one is not found.taken else f"{one.name} ({'taken' if found.gains else 'best found'})"
    changes = [_change(of[measure], factor) for measure, factor in factors]
    walked = _whole_metres(of[WALKED].then.mean)
    return [name, "" if what == one.name else what, walked, _relative(of[WALKED]), *changes]


def _present(value: float) -> str:
    return digits(value) if is_number(value) else NOT_MEASURED


def _whole_metres(metres: float) -> str:
    return f"{metres:,.0f}" if is_number(metres) else ABSENT


def _relative(one: Against) -> str:
    mean, half = (100 * value for value in one.relative)
    if one.identical:
        return "0"
    if not is_number(mean) or not is_number(half):
        return ABSENT
    return f"{_signed(mean, half)} ± {half_digits(mean, half)} %" + _unclear(one)


def _change(one: Against, factor: float) -> str:
    mean, half, of = (factor * value for value in (one.difference.mean, one.difference.half_width, one.now.mean))
    if not one.measured:
        return NOT_MEASURED
    if one.identical:
        return "0"
    if not is_number(half):
        return digits(mean)
    return f"{_signed(mean, half, of)} ± {half_digits(mean, half, of)}" + _unclear(one)


def _signed(value: float, half: float, of: float = 0.0) -> str:
    text = digits(value, half, of)
    return f"+{text}" if value > 0 and text.strip("0.,") else text


def _unclear(one: Against) -> str:
    return "" if one.clear or one.identical else " ?"


WHERE_TO_PASTE = "Where the file has overrides or scenarios already, write there only the lines that it lacks."


def _override(found: LayoutFound) -> Iterator[StudySection]:
    if found.taken is not None:
        gained = bool(found.gains)
        title = "To paste into the scenario" if gained else "The best layout found, to paste: it shows no clear gain"
        yield StudySection(title, [WHERE_TO_PASTE], code=override_text([found.taken]), on_screen=gained)
    others = [one for one in found.candidates if one is not found.taken]
    if others:
        yield StudySection("The other layouts, to paste", [WHERE_TO_PASTE], code=override_text(others))


def _flows(found: LayoutFound) -> Iterator[StudySection]:
    flows = found.flows.largest_first()
    total = found.flows.walked_m_per_h
    title = f"Flows now: {_km(total)} walked an hour by all together"
    shown = Table(_FLOW_COLUMNS, [_flow_row(found, flow, total) for flow in flows[:ON_SCREEN]], words=2)
    if len(flows) > ON_SCREEN:
        yield StudySection(f"{title} ({ON_SCREEN} of {len(flows)} ways)", table=shown, on_screen=True, on_page=False)
        yield StudySection(title, table=Table(_FLOW_COLUMNS, [_flow_row(found, f, total) for f in flows], words=2))
    else:
        yield StudySection(title, table=shown, on_screen=True)
    if found.flows_then is not None and found.taken is not None:
        then, all_then = found.flows_then.largest_first(), found.flows_then.walked_m_per_h
        rows = [_flow_row(found, flow, all_then, found.taken) for flow in then]
        yield StudySection(f"All flows then: {_km(all_then)} an hour", table=Table(_FLOW_COLUMNS, rows, words=2))
    driven = found.flows.largest_first(of=found.flows.driven)
    if driven:
        rows = [_flow_row(found, flow, found.flows.driven_m_per_h)[:2] + _driven_cells(flow) for flow in driven]
        yield StudySection("Drives of vehicles now", table=Table(("from", "to", "drives/h"), rows, words=2))


_FLOW_COLUMNS = ("between", "and", "trips/h", "with a job", "m", "m/h", "share")


def _driven_cells(flow: Flow) -> list[str]:
    return [f"{flow.trips_per_h:.1f}"]


def _flow_row(found: LayoutFound, flow: Flow, total: float, one: Candidate | None = None) -> list[str]:
    at = found.asked.floor.at if one is None else one.at
    ends = [_place(place, at) for place in (flow.start, flow.end)]
    numbers = (f"{flow.trips_per_h:.1f}", f"{flow.with_a_job_per_h:.1f}", f"{flow.distance_m:.1f}")
    return [*ends, *numbers, f"{flow.metres_per_h:,.0f}", f"{100 * flow.metres_per_h / total:.1f} %"]


def _place(place: str, at: Any) -> str:
    stations = [station for station, there in at.items() if there == place]
    return f"{' and '.join(stations)} ({place})" if stations and stations != [place] else place


def _words(found: LayoutFound) -> Iterator[str]:
    floor = found.asked.floor
    yield (
        "Trips are counted in the simulation of the present layout, and proposals put the stations where these trips "
        "are short (quadratic assignment: Koopmans & Beckmann 1957; scipy's FAQ, then exchanges of two). That knows "
        "nothing of queues and of who is free, so every proposal is simulated too, and only that decides."
    )
    yield (
        f"Taken is, of the layouts that no test tells from the best by {kpi_name(found.asked.best.kpi).lower()} "
        "(paired, all together, Holm 1979), the one with the least walking. Those clearly worse than the present one "
        "are left out."
    )
    yield "Mirror images of a layout, with the same distances between all stations, are one proposal."
    yield "A station takes along its buffer; stores, belts, vehicles' stands and people's homes stay where they are."
    tied = [f"{name} ({why})" for name, why in floor.tied.items()]
    if found.asked.free is not None and tied:
        yield f"Left where they are: {enumerated(tied)}."
    if found.asked.free is not None and floor.scenario.layout.distance == "paths" and not found.asked.free.exclusive:
        yield "With paths, free places may be crossings: stations are put there only where 'places' names them."


def _km(metres: float) -> str:
    return f"{metres / 1000:.2f} km" if metres >= 1000 else f"{metres:.0f} m"

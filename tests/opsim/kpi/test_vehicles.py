"""Known answers: a truck that brings two jobs, rows made by hand."""

import pytest
from plans import plan

from opsim.engine.floor import run_plan
from opsim.kpi.resources import transporters

TRUCK = """
opsim: 1
name: truck
run: {horizon: 200 s, warm_up: WARM_UP, seed: 1}
layout: {places: {a: [0 m, 0 m], b: [20 m, 0 m], dock: [0 m, 10 m]}}
tasks: {cut: {fixed: 5 s, automatic: true}, pack: {fixed: 1 s, automatic: true}}
stations: {saw: {at: a, tasks: [cut], buffer: 9}, packer: {at: b, tasks: [pack], buffer: 9}}
transporters:
  truck: {n: 2, at: dock, speed: 2 m/s, load: 3 s, unload: 2 s, legs: [[saw, packer]]}
  idler: {at: a, speed: 1 m/s, legs: [[packer, saw]]}
products: {x: {route: [saw, packer]}}
release: {kind: renewal, every: {fixed: 60 s}}
"""


def found(warm_up="0 s", text=TRUCK):
    p = plan(text.replace("WARM_UP", warm_up))
    return {(f.kpi, f.subject, f.part): f.value for f in transporters(run_plan(p), p)}


def test_states_metres_and_waits_of_two_trips():
    # 65-70 s empty from the dock, 70-73 loaded, 73-83 drive, 83-85 unloaded; 125-130 the other one from the dock (10 m,
    # nearer than 20 m), 130-133, 133-143, 143-145; the third job is cut at 185 s: one from b, 185-195, 195-198, 198-200
    values = found()
    shares = {part: values["transporter_states", "truck", part] for part in ("loaded", "empty", "handling", "free")}
    assert shares == pytest.approx({"loaded": 22 / 400, "empty": 20 / 400, "handling": 13 / 400, "free": 345 / 400})
    assert values["driven_m", "truck", ""] == pytest.approx(2 * 42)
    assert values["pickup_wait_s", "truck", ""] == pytest.approx((8 + 8 + 13) / 3)


def test_the_window_clips_drives_and_counts_jobs_by_their_loading():
    values = found("75 s")
    # left of the first trip: 75-83 loaded, 83-85 unloading
    assert values["transporter_states", "truck", "loaded"] == pytest.approx(20 / 250)
    assert values["driven_m", "truck", ""] == pytest.approx(2 * (8 + 5 + 10 + 10 + 2))
    assert values["pickup_wait_s", "truck", ""] == pytest.approx((8 + 13) / 2)


def test_vehicles_without_work_are_free_and_nobody_waits_for_them():
    values = found()
    assert values["transporter_states", "idler", "free"] == 1
    assert ("pickup_wait_s", "idler", "") not in values


def test_without_transporters_there_are_no_such_figures():
    lines = [line for line in TRUCK.splitlines() if not line.startswith(("transporters", "  truck", "  idler"))]
    assert found(text="\n".join(lines)) == {}

import copy
import json
from dataclasses import replace

import numpy as np
import pytest
from made.scene import packed_scene, run_of, scene

from opsim.ergonomics.angles import elbow_bend_rad, knee_bend_rad, trunk_angles, upper_arm_angles
from opsim.log import WORKER_KINDS
from opsim.viewer.build import scene_of
from opsim.viewer.pose import joints_m
from opsim.viewer.write import packed, write_replay
from tests.browser.chromium import Watched, browser

pytestmark = pytest.mark.browser
AS_OPENED = """() => {
  const replay = opsimReplay;
  replay.pause();
  replay.speed(1);
  replay.select('worker', null);
  replay.variant(replay.variants > 1 ? [0, 1] : 0);
  replay.seek(0);
  document.activeElement.blur();
  const colour = document.getElementById('colour');
  colour.value = 'state';
  colour.dispatchEvent(new Event('change'));
  if (document.getElementById('panel').classList.contains('open')) document.getElementById('shut').click();
  document.querySelector('.notes').open = false;
  document.getElementById('whole').click();
}"""
HOSTILE = "</script><img src=x onerror='window.harmed = 1'><script>window.harmed = 1</script>"


@pytest.fixture(scope="module")
def chromium():
    with browser() as running:
        yield running


@pytest.fixture(scope="module")
def walking():
    """(scene, packed) of people who walk and work, with their RULA scores."""
    found = scene_of(run_of("walking_cell"))
    return found, packed(found)


@pytest.fixture(scope="module")
def files(tmp_path_factory, walking):
    """Pages of one variant and of two."""
    folder, one = tmp_path_factory.mktemp("replay"), walking[1]
    other = packed(replace(walking[0], name="other"))
    written = {
        "one": [one],
        "two": [one, other],
        **{name: [packed_scene(name)] for name in ("kitting", "eight_station_cell", "forklift")},
    }
    for name, parts in written.items():
        write_replay(parts, folder / f"{name}.html", "A cell", [("From", "a test")])
    return folder


@pytest.fixture(scope="module")
def page(files, chromium):
    """A page as it is when it is opened, but paused at its start. Each is opened once: opening costs most."""
    opened = {}

    def watched(name="one", width=1280):
        if (name, width) not in opened:
            opened[name, width] = Watched(chromium, files / f"{name}.html", width)
        found = opened[name, width]
        found(AS_OPENED)
        found.complaints.clear()
        return found

    return watched


def button(watched, name):
    return watched.page.get_by_role("button", name=name, exact=True)


def state(watched):
    return watched("opsimReplay.state()")


def says(watched, what):
    return watched.page.locator(f"#{what}").inner_text()


def drawn(watched):
    """Until the page has drawn what it was told."""
    watched("new Promise(told => requestAnimationFrame(() => requestAnimationFrame(() => told(1))))")


def click(watched, kind, name):
    """On the floor, where a person or a station is seen."""
    x, y = watched(f"opsimReplay.where({json.dumps(kind)}, {json.dumps(name)})")
    watched.page.mouse.click(x, y)
    drawn(watched)


def busy_at(found, worker):
    """A time at which this worker performs a task."""
    rows = range(found.segments.first[worker], found.segments.first[worker + 1])
    row = next(row for row in rows if found.segments.performance[row] >= 0 and found.segments.task[row] >= 0)
    return float(found.segments.start_s[row] + found.segments.end_s[row]) / 2


def in_page(watched, asked):
    each = "([w, t]) => { opsimReplay.seek(t); return [opsimReplay.joints(w), opsimReplay.angles(w)] }"
    return watched(f"{json.dumps(asked)}.map({each})")


@pytest.mark.parametrize("name", ["one", "kitting", "eight_station_cell"])
def test_every_joint_is_within_two_millimetres_of_where_numpy_has_it(page, walking, name):
    shown = walking[0] if name == "one" else scene(name)
    rng = np.random.default_rng(12)
    asked = [(int(rng.integers(len(shown.workers))), float(rng.uniform(shown.low_s, shown.high_s))) for _ in range(150)]
    starts = rng.choice(shown.segments.start_s, 50) + rng.uniform(-0.5, 0.5, 50)  # where one posture goes into the next
    asked += [(int(rng.integers(len(shown.workers))), float(t)) for t in np.clip(starts, shown.low_s, shown.high_s)]
    errors_m = []
    for (worker, time_s), (joints, _) in zip(asked, in_page(page(name), asked)):
        truth = joints_m(shown, worker, time_s)
        assert (truth is None) == (joints is None)
        if truth is not None:
            errors_m.append(np.linalg.norm(np.array(joints) - truth, axis=1).max())
    assert len(errors_m) > 150 and max(errors_m) < 2e-3


def test_the_angles_are_those_of_ergonomics(page, walking):
    found = walking[0]
    asked = [(worker, busy_at(found, worker)) for worker in range(len(found.workers))]
    for (_, _), (joints, angles) in zip(asked, in_page(page(), asked)):
        names, positions = found.standing.skeleton.names, np.array(joints)
        trunk, arms = trunk_angles(positions, names), upper_arm_angles(positions, names)
        elbows, knees = elbow_bend_rad(positions, names), knee_bend_rad(positions, names)
        meant = {"flexion": trunk.flexion_rad, "side_bend": trunk.side_bend_rad, "twist": trunk.twist_rad}
        for at, side in enumerate(("left", "right")):
            meant |= {f"{side}_arm": arms.elevation_rad[at], f"{side}_elbow": elbows[at], f"{side}_knee": knees[at]}
        assert angles == pytest.approx({name: np.rad2deg(float(angle)) for name, angle in meant.items()}, abs=1e-6)


def test_it_asks_for_nothing_and_complains_of_nothing_while_it_is_used(page):
    watched = page("two")
    for key in ("Space", "ArrowRight", "3", "t", "w", "PageDown", "Space", "Shift+ArrowLeft", "+", "-", "?", "Escape"):
        watched.page.keyboard.press(key)
    watched("opsimReplay.select('worker', 0)")
    watched.page.keyboard.press("f")
    drawn(watched)
    watched.page.select_option("#colour", "exposure")
    watched.page.wait_for_timeout(150)
    assert len(watched.requests) == 1 and watched.complaints == []
    assert "default-src 'none'" in watched("document.querySelector('meta[http-equiv]').content")


def test_it_plays_at_the_speed_that_is_chosen_until_paused(files, chromium):
    """By a clock that only the test moves on: a busy machine changes nothing."""
    watched = Watched(chromium, files / "one.html")
    button(watched, "Pause").click()
    clock = watched.page.clock
    clock.install(time=0)
    clock.pause_at(1000)
    watched.page.select_option("#speed", "20")
    button(watched, "Play").click()
    clock.run_for(100)
    begun_s = state(watched)["t"]
    clock.run_for(400)
    assert state(watched)["t"] - begun_s == pytest.approx(8.0, abs=0.5)
    button(watched, "Pause").click()
    still_s = state(watched)["t"]
    clock.run_for(200)
    assert state(watched)["t"] == still_s and says(watched, "play") == "Play"
    watched.page.close()


def test_one_picture_is_drawn_a_frame_whatever_was_asked_for_before(page):
    """The counter of the page is what its speed is judged by: it may not see a picture twice."""
    watched = page("one")
    watched(
        "for (let k = 0; k < 5; k++) { opsimReplay.play(); opsimReplay.seek(k); opsimReplay.select('worker', null) }"
    )
    frames = """new Promise((told) => {
      let n = 0, from = performance.now();
      (function frame() { n++; performance.now() - from < 1500 ? requestAnimationFrame(frame) : told(n / 1.5) })();
    })"""
    assert watched("opsimReplay.state().playing")
    assert any(watched(frames) * 1.6 > watched("opsimReplay.state().fps") for _ in range(5)), "twice as many, always"


def test_pause_tells_the_truth_after_seeking(page):
    watched = page()
    button(watched, "Play").click()
    watched("opsimReplay.seek(100)")
    assert state(watched)["playing"] and says(watched, "play") == "Pause"
    watched("opsimReplay.seek(1e9)")
    assert not state(watched)["playing"] and says(watched, "play") == "Play"
    button(watched, "Play").click()  # at the end: from the beginning
    drawn(watched)
    assert state(watched)["playing"] and state(watched)["t"] < 100 and says(watched, "play") == "Pause"
    watched("opsimReplay.pause()")
    drawn(watched)
    assert says(watched, "play") == "Play"


def test_the_bar_goes_to_any_time_and_the_clock_says_it(page):
    watched = page()
    watched("(t => { t.value = 254.2; t.dispatchEvent(new Event('input')) })(document.getElementById('time'))")
    drawn(watched)
    assert state(watched)["t"] == pytest.approx(254.2) and says(watched, "clock") == "Mon 06:04:14"
    watched.page.keyboard.press("ArrowRight")
    drawn(watched)
    watched.page.keyboard.press("PageUp")
    drawn(watched)
    assert state(watched)["t"] == pytest.approx(195.2)


def test_a_click_on_a_person_tells_of_him(page, walking):
    found, watched = walking[0], page()
    at_s = busy_at(found, 0)
    watched(f"opsimReplay.seek({at_s})")
    name = found.workers[0][0]
    click(watched, "worker", name)
    row = found.segments.row(0, at_s)
    assert state(watched)["selected"] == {"kind": "worker", "name": name, "variant": 0}
    assert says(watched, "who") == name and says(watched, "state") == found.states[found.segments.state[row]]
    task, station = found.tasks[found.segments.task[row]][0], found.benches[found.segments.station[row]].name
    assert task in says(watched, "facts") and station in says(watched, "facts")
    assert "°" in says(watched, "angles")
    least, most = int(found.rula[0, int(at_s * 4)] & 15), int(found.rula[0, int(at_s * 4)] >> 4)
    assert says(watched, "score") == (str(least) if least == most else f"{least} to {most}")


def test_the_panel_names_task_and_station_of_every_segment_as_the_log_has_them(page):
    """Of a floor with conveyors between its stations."""
    watched, log, plan, shown = page("forklift"), run_of("forklift").log(), run_of("forklift").plan, scene("forklift")
    facts = "[...document.querySelectorAll('#facts dd')].slice(0, 2).map(dd => dd.textContent)"
    ask = f"([w, t]) => {{ opsimReplay.select('worker', w); opsimReplay.seek(t); return {facts} }}"
    rows = np.random.default_rng(6).integers(shown.segments.start_s.size, size=60)
    workers = np.searchsorted(shown.segments.first, rows, side="right") - 1
    times_s = (shown.segments.start_s[rows] + shown.segments.end_s[rows]) / 2
    asked = list(zip(workers.tolist(), times_s.tolist()))
    for (worker, at_s), found in zip(asked, watched(f"{json.dumps(asked)}.map({ask})")):
        now = (log["worker"] == worker) & (log["start_s"] <= at_s) & (log["end_s"] > at_s)
        at = int(np.flatnonzero(now & np.isin(log["kind"], WORKER_KINDS))[0])
        meant = [(plan.tasks, int(log["task"][at])), (plan.stations, int(log["station"][at]))]
        assert found == [ones[rank].name if rank >= 0 else "none" for ones, rank in meant]


def test_everybody_on_the_floor_has_a_name_over_him_and_who_is_chosen_always(page):
    """Kits are made by two beside each other; one of them walks three metres from his bench, inside his task."""
    watched, shown = page("kitting"), scene("kitting")
    names = [name for name, _ in shown.workers]
    seen = "[...document.querySelectorAll('.label.worker')].filter(e => !e.hidden).map(e => e.textContent)"
    for at_s in np.linspace(shown.low_s, shown.high_s, 14)[:-1]:
        watched(f"opsimReplay.seek({at_s})")
        there = [name for name in names if watched(f"opsimReplay.joints({json.dumps(name)})")]
        assert sorted(watched(seen)) == sorted(there)
        for name in there:
            watched(f"opsimReplay.select('worker', {json.dumps(name)})")
            assert name in watched(seen)
        watched("opsimReplay.select('worker', null)")


def test_a_click_on_a_station_tells_of_its_queue(page, walking):
    found, watched = walking[0], page()
    click(watched, "station", found.benches[0].name)
    assert state(watched)["selected"] == {"kind": "station", "name": found.benches[0].name, "variant": 0}
    assert "Waiting in front" in says(watched, "facts") and watched.page.locator("#far").is_visible()
    watched.page.keyboard.press("Escape")
    drawn(watched)
    assert state(watched)["selected"] is None and watched.page.locator("#chosen").is_hidden()


def test_people_and_stations_are_chosen_without_a_mouse_too(page, walking):
    found, watched = walking[0], page()
    watched.page.select_option("#workers", label=found.workers[1][0])
    drawn(watched)
    assert state(watched)["selected"]["name"] == found.workers[1][0]
    watched.page.select_option("#stations", label=found.benches[1].name)
    drawn(watched)
    assert state(watched)["selected"]["name"] == found.benches[1].name
    assert watched.page.locator("#workers").input_value() == ""


def test_a_click_into_a_plot_goes_to_that_moment(page, walking):
    watched = page()
    watched("opsimReplay.select('worker', 0)")
    box = watched.page.locator("#far").bounding_box()
    watched.page.mouse.click(box["x"] + box["width"] - 1.5, box["y"] + 20)
    drawn(watched)
    assert state(watched)["t"] == pytest.approx(walking[0].high_s, abs=15)


def test_colours_say_the_state_or_the_exposure(page):
    watched = page()
    assert "work" in says(watched, "legend")
    watched.page.select_option("#colour", "exposure")
    drawn(watched)
    assert state(watched)["by"] == "exposure" and says(watched, "legend").startswith("RULA 1–2")
    assert "not known" in says(watched, "legend")
    assert "shirt: at least" in says(watched, "legend") and "ring on the floor: at most" in says(watched, "legend")


def test_exposure_is_not_offered_where_it_was_not_measured(page):
    assert page("kitting").page.locator("#colour option[value=exposure]").is_disabled()


def test_two_variants_stand_side_by_side_on_one_clock_and_one_alone(page):
    watched = page("two")
    assert state(watched)["variant"] == [0, 1]
    assert watched.page.locator(".view h2").all_inner_texts()[1].startswith("other")
    boxes = [one.bounding_box() for one in watched.page.locator(".view").all()]
    assert boxes[0]["x"] + boxes[0]["width"] == boxes[1]["x"] and boxes[0]["width"] == boxes[1]["width"]
    watched("opsimReplay.seek(300); opsimReplay.select('worker', 0)")
    left = watched("opsimReplay.joints(0)")
    watched("opsimReplay.variant(1); opsimReplay.seek(300); opsimReplay.select('worker', 0)")
    assert state(watched)["variant"] == [1] and watched("opsimReplay.joints(0)") == left
    assert watched.page.locator(".view").count() == 1


def test_the_followed_stay_in_the_picture(page):
    watched = page()
    watched("opsimReplay.select('worker', 0)")
    button(watched, "Follow").click()
    stage = watched.page.locator("#stage").bounding_box()

    def in_the_middle():
        x, y = watched("opsimReplay.where('worker', opsimReplay.state().selected.name)")
        return abs(x - stage["x"] - stage["width"] / 2) < 60 and abs(y - stage["y"] - stage["height"] / 2) < 90

    for at_s in (60, 700, 1400):
        watched(f"opsimReplay.seek({at_s})")
        assert any(in_the_middle() or watched.page.wait_for_timeout(50) for _ in range(600)), "the camera is long there"


def test_a_legend_of_nobody_is_no_empty_box(page):
    watched = page()
    shown = "getComputedStyle(document.getElementById('legend')).display"
    assert watched(shown) == "flex"
    watched("document.getElementById('legend').replaceChildren()")
    assert watched(shown) == "none"


@pytest.mark.parametrize("name", ["one", "two"])
def test_nothing_sticks_out_on_a_phone(page, name):
    watched = page(name, 390)
    watched("opsimReplay.select('worker', 0)")
    button(watched, "Details").click()
    drawn(watched)
    out = """[...document.querySelectorAll('button, select, input, output, h1, h2, canvas, dl, table')]
        .map(e => [e.id || e.tagName, e.getBoundingClientRect()])
        .filter(([name, b]) => b.width && (b.left < 0 || b.right > innerWidth + 0.5)).map(([name]) => name)"""
    assert watched(out) == [] and watched("document.documentElement.scrollWidth") <= 390
    assert watched.page.locator("#angles").is_visible()
    button(watched, "close the details").click()
    drawn(watched)
    assert watched.page.locator("#angles").is_hidden()


def test_hostile_names_do_no_harm_and_are_shown_as_they_are(walking, chromium, tmp_path):
    meta, columns = copy.deepcopy(walking[1])
    for kind in ("workers", "stations", "tasks", "products", "places"):
        for one in meta[kind]:
            one["name"] = HOSTILE
    meta["name"] = HOSTILE
    write_replay([(meta, columns), (meta, columns)], tmp_path / "hostile.html", HOSTILE, [(HOSTILE, HOSTILE)])
    watched = Watched(chromium, tmp_path / "hostile.html")
    for kind in ("worker", "station"):
        watched(f"opsimReplay.select({json.dumps(kind)}, 0)")
        assert says(watched, "who") == HOSTILE
    assert watched("window.harmed") is None and watched("document.querySelectorAll('img').length") == 0
    assert watched("document.title") == HOSTILE and watched.complaints == []
    watched.page.close()


def test_who_wants_less_motion_sees_a_still_page_first(files, chromium):
    calm = chromium.new_page(reduced_motion="reduce")
    calm.goto((files / "one.html").as_uri())
    calm.wait_for_selector("html[data-drawn]")
    assert calm.locator("#play").inner_text() == "Play"
    calm.close()


def test_without_webgl_it_says_so(files, chromium):
    plain = chromium.new_page()
    plain.add_init_script("HTMLCanvasElement.prototype.getContext = () => null")
    plain.goto((files / "one.html").as_uri())
    plain.wait_for_selector("html[data-drawn=no]")
    assert "needs WebGL" in plain.locator("#word").inner_text()
    plain.close()

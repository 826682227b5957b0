"""Changes of a layout as overrides, and what is refused."""

import pytest
import yaml

from opsim.scenario.fields import read_any_moved
from opsim.scenario.read import read_scenarios
from opsim.scenario.study_checks import Varied
from opsim.study.layout.floor import NoLayout, movable
from opsim.study.layout.moves import Candidate, candidate, override_text
from opsim.study.layout.study import said
from tests.opsim.study.layout.made_floor import FLOOR, asked, written


@pytest.fixture
def floor(tmp_path):
    return asked(written(tmp_path)).floor


def made(floor, *texts):
    return candidate(floor, "new", [read_any_moved(text) for text in texts])


def wrong(floor, *texts):
    with pytest.raises(NoLayout) as error:
        made(floor, *texts)
    return str(error.value)


def test_stations_that_change_places_are_told_their_new_ones(floor):
    assert made(floor, "swap saw,drill").changes == {"stations.drill.at": "p1", "stations.saw.at": "p5"}


def test_changes_follow_each_other(floor):
    one = made(floor, "swap saw,drill", "place saw=p2", "move p2=6 m, 1.5 m")
    assert one.at == {"drill": "p1", "pack": "p3", "saw": "p2"}
    assert one.changes["layout.places.p2"] == ["6 m", "1.5 m"] and one.moved == {"p2": (6.0, 1.5)}


def test_a_place_with_heights_keeps_them_where_it_is_moved(tmp_path):
    heights = FLOOR.replace("p2: [5 m, 0 m]", "p2: {at: [5 m, 0 m], levels: {low: 0.3 m}}")
    assert heights != FLOOR
    floor = asked(written(tmp_path, heights)).floor
    changes = made(floor, "move p2=6 m, 1.5 m").changes
    assert changes == {"layout.places.p2.at": ["6 m", "1.5 m"]}
    moved = Varied.read(floor.loaded.file).with_changes(changes).scenario.layout
    assert moved.places["p2"] == (6.0, 1.5) and moved.with_heights["p2"].heights_m == {"low": 0.3}


def test_what_is_done_and_undone_changes_nothing(floor):
    assert made(floor, "swap saw,drill", "swap drill,saw").changes == {}


def test_a_station_more_is_one_of_two_in_routes_and_for_whoever_has_the_skill(floor):
    changes = made(floor, "add second=like drill at p2").changes
    assert changes == {
        "stations.second": {"like": "drill", "at": "p2"},
        "products.part.route": ["saw", ["drill", "second"], "pack"],
        "workers.ana.skills.second": 0.9,
        "workers.ben.skills.second": 0.9,
        "workers.ben.zone": ["drill", "pack", "second"],
    }
    scenario = Varied.read(floor.loaded.file).with_changes(changes).scenario
    assert scenario.stations["second"].tasks == ["t"] and scenario.workers["ben"].skills["second"] == 0.9


def test_two_more_stations_are_both_in_the_route(floor):
    changes = made(floor, "add second=like drill at p2", "add third=like drill at p4").changes
    assert changes["products.part.route"] == ["saw", ["drill", "second", "third"], "pack"]
    assert changes["workers.ben.zone"] == ["drill", "pack", "second", "third"]


def test_the_override_that_is_printed_says_the_same(floor, tmp_path):
    moves = ["swap saw,drill", "place pack=p4", "move p2=6 m, 1.5 m", "add second=like drill at p2"]
    one = made(floor, *moves)
    pasted = written(tmp_path, FLOOR + override_text([one]), "pasted.yaml")
    assert read_scenarios(pasted)["new"].scenario == Varied.read(pasted).with_changes(one.changes).scenario
    assert max(map(len, override_text([one]).splitlines())) <= 120


def test_names_with_spaces_become_keys_that_can_be_pasted():
    one = Candidate("swap saw,drill", {"stations.saw.at": "p5"}, {})
    text = yaml.safe_load(override_text([one]))
    assert text["overrides"] == {"swap_saw_drill": {"stations.saw.at": "p5"}}
    assert text["scenarios"] == {"base": [], "swap_saw_drill": ["swap_saw_drill"]}


def test_who_inherits_his_place_is_told_where_he_stays(tmp_path):
    twin = FLOOR.replace("products:", "  twin: {like: saw}\nproducts:").replace("[saw, drill", "[[saw, twin], drill")
    twin = twin.replace("skills: {saw: 1.0", "skills: {twin: 1.0, saw: 1.0")
    floor = asked(written(tmp_path, twin)).floor
    one = made(floor, "place saw=p2")
    assert one.changes == {"stations.saw.at": "p2", "stations.twin.at": "p1"}
    scenario = Varied.read(floor.loaded.file).with_changes(one.changes).scenario
    assert {name: station.at for name, station in scenario.stations.items()} == dict(one.at)


def test_unknown_words_are_answered_with_the_nearest(floor):
    assert "no station 'dril'; did you mean 'drill'?" in wrong(floor, "swap saw,dril")
    assert "no place 'doors'; did you mean 'door'?" in wrong(floor, "place saw=doors")
    assert "there is a pack already" in wrong(floor, "add pack=like drill at p2")


def test_two_stations_are_not_put_on_one_place(floor):
    assert "drill and saw would stand at one place, p5" in wrong(floor, "place saw=p5")
    assert "would stand at one place, p2" in wrong(floor, "place saw=p2", "place drill=p2")


def test_stations_that_share_a_place_today_may_go_on_sharing(tmp_path):
    floor = asked(written(tmp_path, FLOOR.replace("drill: {at: p5", "drill: {at: p1"))).floor
    assert made(floor, "place pack=p2").at["saw"] == "p1"
    assert "drill, pack and saw would stand at one place, p1" in wrong(floor, "place pack=p1")


def test_moves_in_words(floor):
    before = floor.at
    assert said(before, made(floor, "swap saw,drill")) == "swap drill and saw"
    assert said(before, made(floor, "swap saw,drill", "place pack=p4")) == "swap drill and saw and move pack to p4"
    assert said(before, made(floor, "place pack=p4", "place saw=p2")) == "move pack to p4 and saw to p2"
    assert said(before, made(floor, "move p2=6 m, 1 m")) == "put p2 at (6 m, 1 m)"


def test_by_default_stations_go_where_they_stand_and_where_nothing_is(floor):
    free = movable(floor)
    assert free.things == ("p1", "p3", "p5") and free.allowed == ("p1", "p2", "p3", "p4", "p5")
    assert movable(floor, fixed=["saw"]).allowed == ("p2", "p3", "p4", "p5")


@pytest.mark.parametrize(
    "fixed, places, words",
    [
        (["saw", "drill", "pack"], None, "no station may be moved"),
        (["sow"], None, "no station 'sow'; did you mean 'saw'?"),
        ([], ["p1", "p2"], "3 stations (drill, pack and saw) and only 2 places"),
        (["saw"], ["p1", "p2", "p3"], "saw stays at p1: nothing else can stand there"),
    ],
)
def test_what_cannot_be_is_refused_with_the_reason(floor, fixed, places, words):
    with pytest.raises(NoLayout) as error:
        movable(floor, fixed, places)
    assert words in str(error.value)


def test_a_place_that_no_path_reaches_is_refused_and_crossings_are_no_places_for_stations(tmp_path):
    paths = FLOOR.replace("layout:\n", "layout:\n  distance: paths\n  paths: [[door, p1, p2, p3, p4, p5]]\n")
    paths = paths.replace("door: [0 m, 9 m]", "door: [0 m, 9 m], island: [9 m, 9 m]")
    floor = asked(written(tmp_path, paths)).floor
    assert movable(floor).allowed == ("p1", "p3", "p5")
    assert movable(floor, places=["p1", "p2", "p4"]).allowed == ("p1", "p2", "p4")
    with pytest.raises(NoLayout, match="no path leads from p5 to island"):
        movable(floor, places=["p1", "p2", "island"])


def test_changes_that_are_possible_each_but_clash_leave_out_all_together(tmp_path):
    one = asked(written(tmp_path), place=["saw=p2"], add=["second=like drill at p2"])
    assert [each.name for each in one.what_ifs] == ["place saw=p2", "add second=like drill at p2"]
    assert one.clash.startswith("saw and second would stand at one place, p2")


def test_what_is_wrong_with_one_change_is_said_once(tmp_path):
    one = asked(written(tmp_path), place=["saw=p3", "drill=p2"])
    with pytest.raises(NoLayout) as error:
        one.check()
    assert str(error.value).count("would stand at one place") == 1

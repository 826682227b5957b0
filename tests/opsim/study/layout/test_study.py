"""The whole study on a small floor: known answers, laws, and the same whoever computes it.

The shipped eight-station cell: its layout is a random one of the middle, and the study finds a better one.

The whole of it, with all 200 random layouts simulated: ``PYTHONPATH=tests python -m study_evidence.layout``.
"""

from dataclasses import replace

import numpy as np
import pytest
from study_evidence.layout import EACH, FILE, asked_for, drawn, shipped

from opsim.kpi.catalogue import read_asked
from opsim.report.page import study_html
from opsim.report.studies.layout import layout_page
from opsim.study.jobs import Answers, Job, Point, Source
from opsim.study.layout.evaluate import BEST, EXPOSURE, WALKED, _worst, against, exposure_asked, flows_of
from opsim.study.layout.floor import NoLayout
from opsim.study.layout.study import NOW, chosen, study_layout, summary
from tests.opsim.study.layout.made_floor import FLOOR, answers, asked, written


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    return written(tmp_path_factory.mktemp("layout"))


@pytest.fixture(scope="module")
def found(file):
    of = asked(file, replications=4, proposals=3, what_ifs={"far": ["place pack=p4"]})
    return study_layout(of, answers(file, of))


def test_neighbours_are_put_beside_each_other(found):
    """The parts go saw, drill, pack: the best row has the drill between the others, five metres from each."""
    at = found.taken.at
    places = ["p1", "p2", "p3", "p4", "p5"]
    rank = {station: places.index(place) for station, place in at.items()}
    assert abs(rank["drill"] - rank["saw"]) == 1 and abs(rank["drill"] - rank["pack"]) == 1
    assert found.proposals.exact


def test_the_layout_taken_is_better_on_fresh_numbers_in_walking_and_output(found):
    assert found.fresh[WALKED].difference.high < 0 < found.fresh[BEST].difference.low
    assert found.fresh[BEST].difference.n == 4


def test_what_shows_no_gain_on_fresh_numbers_is_not_given_to_paste_on_the_screen(found):
    page = layout_page(replace(found, fresh=against({"same": found.now}, found.now)["same"]))
    assert page.answer[0].startswith("Leave it as it is") and page.answer[1].startswith("That was to ")
    assert not any(section.code and section.on_screen for section in page.sections)
    assert any(section.code and section.on_screen for section in layout_page(found).sections)


def test_todays_trips_cost_what_people_walk_today(found):
    assert found.proposals.now_m_per_h == pytest.approx(found.flows.walked_m_per_h)
    assert found.flows.walked_m_per_h == pytest.approx(found.now[WALKED].mean(), rel=0.02)
    assert sum(flow.metres_per_h for flow in found.flows.largest_first()) == pytest.approx(found.flows.walked_m_per_h)


def test_a_layout_somebody_asked_for_is_simulated_beside_the_proposals(found):
    assert [one.name for one in found.candidates if not one.proposed] == ["far"]
    assert found.compared["far"][BEST].difference.n == 4


def test_the_same_study_is_told_in_the_same_bytes(file, found):
    again = study_layout(found.asked, answers(file, found.asked))
    assert study_html(layout_page(again)) == study_html(layout_page(found)) and summary(again) == summary(found)


def test_what_stations_are_called_changes_no_figure(tmp_path, found):
    other = FLOOR
    for old, new in (("saw", "zebra"), ("pack", "aback")):
        other = other.replace(old, new)
    file = written(tmp_path, other)
    of = asked(file, replications=4, proposals=3, what_ifs={"far": ["place aback=p4"]})
    again = study_layout(of, answers(file, of))
    assert again.proposals.best_m_per_h == pytest.approx(found.proposals.best_m_per_h, rel=0.05)
    assert len(again.candidates) == len(found.candidates)


def test_fixed_stations_stay_in_every_proposal(file):
    of = asked(file, replications=2, proposals=4, fixed=["drill"], places=["p3", "p4"])
    again = study_layout(of, answers(file, of))
    assert again.candidates and all(one.at["drill"] == "p5" for one in again.candidates)
    assert all({one.at["saw"], one.at["pack"]} == {"p3", "p4"} for one in again.candidates)


def test_where_nobody_walks_nothing_can_be_gained(tmp_path):
    still = FLOOR.replace("at: p3", "at: p1").replace("at: p5", "at: p1").replace("home: door, ", "")
    file = written(tmp_path, still)
    of = asked(file, replications=2)
    with pytest.raises(NoLayout, match="nobody walks in 2 replications"):
        study_layout(of, answers(file, of))


def test_nothing_asked_is_refused(file):
    with pytest.raises(NoLayout, match="no proposals and no change are asked for"):
        asked(file, proposals=0).check()


def test_a_place_that_moves_takes_its_ways_along(file):
    of = asked(file, replications=2, proposals=0, what_ifs={"nearer": ["move p5=11 m, 0 m"]}, best="less walked_m")
    again = study_layout(of, answers(file, of))
    assert again.taken is not None and again.taken.name == "nearer"
    far = {(flow.start, flow.end): flow.distance_m for flow in again.flows_then.largest_first()}
    assert far["p3", "p5"] == 1.0 and far["p1", "p5"] == 11.0


def test_of_layouts_that_no_test_tells_apart_the_one_with_least_walking_is_taken():
    luck = np.random.default_rng(1).normal(size=20)
    layouts = {
        NOW: {BEST: 50 + luck, WALKED: 900 + luck},
        "much": {BEST: 60 + luck, WALKED: 800 + luck},
        "less": {BEST: 60 + np.roll(luck, 3), WALKED: 600 + luck},
        "least": {BEST: 51 + luck, WALKED: 100 + luck},
    }
    name, alike = chosen(layouts, read_asked("throughput_per_h"), NOW)
    assert name == "less" and set(alike) == {"much", "less"}


def test_what_is_clearly_worse_than_now_is_not_taken_for_less_walking():
    """The best is so noisy that no test tells the short one from it; from the present one it is told."""
    rng = np.random.default_rng(4)
    luck, noise = rng.normal(size=20), 40 * rng.normal(size=20)
    layouts = {
        NOW: {BEST: 50 + luck, WALKED: 900 + luck},
        "short": {BEST: 48 + luck, WALKED: 100 + luck},
        "noisy": {BEST: 55 + luck + noise - noise.mean(), WALKED: 950 + luck},
    }
    name, alike = chosen(layouts, read_asked("throughput_per_h"), NOW)
    assert name == NOW and set(alike) == {NOW, "noisy"}


def test_a_layout_whose_figures_are_missing_is_not_taken():
    luck, none = np.random.default_rng(1).normal(size=20), np.full(20, np.nan)
    layouts = {
        NOW: {BEST: 50 + luck, WALKED: 900 + luck},
        "lame": {BEST: none, WALKED: none},
        "once": {BEST: 60 + luck, WALKED: np.r_[np.nan, 800 + luck[1:]]},
    }
    assert chosen(layouts, read_asked("throughput_per_h"), NOW) == ("once", ["once"])


def test_the_tests_of_a_measure_are_held_together():
    rng = np.random.default_rng(2)
    now = {BEST: rng.normal(size=10)}
    layouts = {str(k): {BEST: rng.normal(size=10) + 0.8} for k in range(6)}
    compared = against(layouts, now)
    assert all(one[BEST].p_together >= one[BEST].p for one in compared.values())


def test_the_second_criterion_is_the_first_exposure_among_the_outputs():
    assert exposure_asked(["throughput_per_h", "walking_min_per_h", "rula_mean", "reba_mean"], None).kpi == "rula_mean"
    assert exposure_asked(["throughput_per_h"], None) is None
    assert exposure_asked(["rula_mean"], "less posture_dose/ana").name == "posture_dose/ana"


def test_flows_of_a_layout_are_the_mean_of_its_replications(file, found):
    kept = answers(file, found.asked)
    ways = found.asked.floor.ways
    each = [flows_of(kept, [Job(Point(NOW, {}), n)], ways).walked for n in range(3)]
    both = flows_of(kept, [Job(Point(NOW, {}), n) for n in range(3)], ways).walked
    assert np.allclose(both, np.mean(each, axis=0))


def test_the_worker_who_has_most_of_it_is_one_of_those_of_whom_it_is_known():
    keys = [("rula_from_5_min_per_h", name, "", "min/h") for name in ("", "ana", "ben")]
    values = np.array([[1.0, 2.0, np.nan], [1.0, np.nan, np.nan], [3.0, 2.0, 4.0]])
    most = _worst(keys, values, read_asked("rula_from_5_min_per_h"))
    np.testing.assert_array_equal(most, [2.0, np.nan, 4.0])


def test_an_exposure_that_is_not_measured_says_so_in_its_column(found):
    block = found.asked.block.model_copy(update={"exposure": "rula_from_5_min_per_h"})
    nothing = np.full(4, np.nan)
    now = {**found.now, EXPOSURE: nothing}
    unknown = against({"x": {**found.now, EXPOSURE: nothing}}, now)["x"][EXPOSURE]
    compared = {name: {**of, EXPOSURE: unknown} for name, of in found.compared.items()}
    made = replace(found, asked=replace(found.asked, block=block), now=now, compared=compared)
    section = next(one for one in layout_page(made).sections if one.title.startswith("Layouts"))
    assert all(row[-1] == "not measured" for row in section.table.rows)
    assert "Not measured: no work that is done here has a known posture" in section.sentences[0]


NUMBER = 67
"""Which of the random layouts is shipped."""


@pytest.mark.slow
def test_the_shipped_layout_is_a_random_one_and_about_half_of_others_walk_less():
    layouts = drawn(range(12), each=EACH, processes=1)
    base = drawn([NUMBER], each=EACH, processes=1)[0]
    less = np.mean([one.walked_m_per_h < base.walked_m_per_h for one in layouts])
    assert base.at == shipped() and 0.2 <= less <= 0.8


@pytest.mark.slow
def test_the_proposal_for_the_shipped_cell_is_better_in_walking_and_throughput_on_fresh_numbers():
    asked = asked_for({"proposals": 1, "replications": 5, "exposure": "walked_m"})  # no postures: a third of the time
    found = study_layout(asked, Answers(Source(FILE, asked.kept), processes=1))
    assert found.taken is not None and found.taken.proposed
    assert found.fresh[WALKED].difference.high < 0 < found.fresh[BEST].difference.low
    assert found.fresh[WALKED].relative[0] < -0.25

from xml.etree import ElementTree

import numpy as np
import pytest

from opsim.report.page import study_html
from opsim.report.studies.response_surface import colour
from opsim.report.studies.sweep import MOST_ROWS, beside_answer, sweep_page
from opsim.report.studies.sweep_charts import tornado_svg
from opsim.report.studies.sweep_sentences import fit_sentences, sentences_of
from opsim.scenario.schema.sweep import Sweep
from opsim.study.sweep.factors import points_of
from opsim.study.sweep.study import found_of

KEY = ("throughput_per_h", "", "", "1/h")
VARY = {"release.every": {"from": "40 s", "to": "60 s", "levels": 3}, "stations.<b>.buffer": [1, 2, 4]}


def made(figure, noise=0.05, replications=6, **said):
    """(points, found) of a figure that is a function of the factors' numbers."""
    points = points_of(Sweep.model_validate({"vary": VARY, **said}), 3)
    rng = np.random.default_rng(2)
    luck = rng.normal(0, 1, (1, replications)) + rng.normal(0, noise, (len(points.values), replications))
    values = np.array([figure(*row) for row in points.numbers()])[:, None] + luck * noise
    return points, found_of(KEY, "more", points, values, 3)


def test_the_factor_that_matters_most_comes_first_and_the_others_hardly():
    points, found = made(lambda every, buffer: 100 - every + 0.02 * buffer)
    said = sentences_of(found, points)[0]
    assert said.startswith("Throughput (good units) goes up most with release.every: +20.00")
    assert "from 60 s to 40 s. stations.<b>.buffer hardly matters for it" in said


def test_most_is_not_said_where_what_is_unsure_may_be_more():
    points = points_of(Sweep.model_validate({"vary": VARY}), 3)
    every, buffer = points.numbers().T
    values = buffer[:, None] + (every[:, None] - 50) * np.array([[3.0, -1, 2, -2]])
    said = sentences_of(found_of(KEY, "more", points, values, 3), points)[0]
    assert "goes up clearly with stations.<b>.buffer" in said and "Whether release.every does anything" in said


@pytest.mark.parametrize(
    "figure, noise, said",
    [
        (lambda every, buffer: 100 - every * buffer / 9, 0.05, "may be read between the points"),
        (lambda every, buffer: 100.0, 5.0, "not to be trusted"),
        (lambda every, buffer: 100 + 9 * np.sign(every - 55) + np.sin(every), 0.01, "Do not trust the fit"),
    ],
)
def test_a_fit_says_whether_it_is_to_be_trusted(figure, noise, said):
    vary = {**VARY, "release.every": {"from": "40 s", "to": "60 s", "levels": 9}}
    assert said in fit_sentences(made(figure, noise, vary=vary)[1])[1]


def test_two_figures_stand_against_each_other_where_it_is_known_which_way_is_better():
    points = points_of(Sweep.model_validate({"vary": {"places.bench.surface": ["0.9 m", "1.1 m", "1.3 m"]}}), 3)
    luck = np.random.default_rng(4).normal(0, 0.01, (3, 4))
    more = found_of(KEY, "more", points, np.array([[60.0], [64.0], [62.0]]) + luck, 3)
    less = found_of(
        ("rula_from_5_min_per_h", "", "", "min/h"), "less", points, np.array([[9.0], [5.0], [4.0]]) + luck, 3
    )
    section = sweep_page("bench", points, [more, less], 4, 3).sections[0]
    assert section.title.endswith("against Throughput (good units)")
    assert "no variant beats 1.1 m and 1.3 m" in section.sentences[0]
    assert section.sentences[1].startswith("Clearly beaten: 0.9 m by 1.1 m and 1.3 m")
    assert "0.9 m: clearly beaten" in section.picture
    no_way = found_of(KEY, "", points, np.ones((3, 4)), 3)
    for alone in ([more], [more, no_way]):
        assert not any("against" in one.title for one in sweep_page("bench", points, alone, 4, 3).sections)


@pytest.mark.parametrize("design", ["grid", "latin_hypercube", "one_at_a_time"])
def test_names_are_escaped_and_pictures_are_sound(design):
    points, found = made(lambda every, buffer: 0 if np.isnan(every + buffer) else every - buffer, design=design)
    page = study_html(sweep_page("<i>line</i>", points, [found], 6, 3))
    assert "<b>" not in page and "<i>" not in page and "&lt;b&gt;" in page
    for picture in page.split("<svg")[1:]:
        ElementTree.fromstring("<svg" + picture.partition("</svg>")[0] + "</svg>")


def test_of_many_points_only_the_first_are_shown():
    points, found = made(lambda every, buffer: every, points=300, design="latin_hypercube", replications=2)
    page = sweep_page("Line", points, [found], 2, 3)
    table = page.sections[-1]
    assert len(table.table.rows) == MOST_ROWS and "all of them are in figures.parquet" in table.sentences[0]


def test_a_tornado_of_nothing_is_no_picture():
    assert tornado_svg([], "1/h", 1.0, "the base") == ""


def test_colours_go_from_pale_to_dark_and_unknown_is_grey():
    assert colour(0, 0, 1)[0] == "#f7fbff" and colour(1, 0, 1) == ("#005c94", "#ffffff")
    assert colour(float("nan"), 0, 1)[0] == "#e3e6ea" and colour(5, 5, 5)[0].startswith("#")


def test_one_replication_says_that_it_says_nothing_of_chance():
    points, found = made(lambda every, buffer: every, replications=1)
    assert "one replication of each point says nothing of chance" in sentences_of(found, points)[0]
    assert "by one replication" in sentences_of(found, points)[1]


def test_a_study_with_a_point_without_value_still_stands():
    points = points_of(Sweep.model_validate({"vary": VARY}), 3)
    values = np.random.default_rng(0).normal(5, 1, (9, 4))
    values[0] = np.nan
    page = sweep_page("Line", points, [found_of(KEY, "more", points, values, 3)], 4, 3)
    assert "nan" not in study_html(page).replace("tornado", "")


def test_a_factor_of_one_value_is_said_to_be_not_varied_and_not_to_matter_little():
    points, found = made(lambda every, buffer: every, vary={**VARY, "stations.<b>.buffer": [2]})
    page = sweep_page("Line", points, [found], 6, 3)
    assert "stations.<b>.buffer has one value, so it was not varied." in page.answer
    assert not any("matter" in sentence for sentence in page.answer) and len(page.sections[0].table.rows) == 1


def test_the_best_is_said_to_be_picked_and_of_two_points_to_be_ahead_of_the_other():
    points = points_of(Sweep.model_validate({"vary": {"stations.a.buffer": [1, 2]}}), 3)
    values = points.numbers() + np.random.default_rng(0).normal(0, 0.1, (2, 6))
    found = found_of(KEY, "more", points, values, 3)
    said = sentences_of(found, points)
    assert said[1].endswith("ahead of the other (picked, so likely flattered; 'opsim select' looks again).")
    assert sentences_of(found, points, first=False)[1].endswith("(picked, so likely flattered).")


def test_an_effect_by_a_fit_that_is_not_to_be_trusted_is_not_told():
    vary = {**VARY, "release.every": {"from": "40 s", "to": "60 s"}}
    points, found = made(lambda every, buffer: 9 * np.sin(every), vary=vary, points=20)
    page = sweep_page("Line", points, [found], 6, 3)
    assert "the fitted response is not to be trusted, so what each factor does is not told" in page.answer[0]
    assert {row[-1] for row in page.sections[0].table.rows} == {"fit not trusted"}


def test_a_fit_that_is_a_little_off_names_its_own_shape():
    vary = {"stations.a.buffer": list(range(12))}
    points = points_of(Sweep.model_validate({"vary": vary}), 3)
    x = points.numbers()[:, 0]
    values = (10 * x + 2 * (-1) ** x)[:, None] + np.random.default_rng(1).normal(0, 0.1, (12, 6))
    found = found_of(KEY, "more", points, values, 3)
    assert found.response.kind == "linear" and "is a little other than straight lines." in fit_sentences(found)[1]


def test_figures_per_scheduled_hour_are_not_compared_silently_where_shifts_are_varied():
    points = points_of(Sweep.model_validate({"vary": {"shifts.early.from": ["6:00", "7:00"]}}), 3)
    found = found_of(KEY, "more", points, np.random.default_rng(0).normal(5, 1, (2, 4)), 3)
    assert any("points with other hours are not comparable" in said for said in beside_answer(points, [found]))


def test_points_that_a_design_does_not_use_are_said_beside_the_answer():
    points, found = made(lambda every, buffer: every, design="grid", points=50)
    assert any("'points: 50' is not used" in said for said in sweep_page("Line", points, [found], 6, 3).answer)


def test_missing_values_say_how_many_replications_were_compared():
    points = points_of(Sweep.model_validate({"vary": VARY}), 3)
    values = np.random.default_rng(0).normal(5, 1, (9, 6))
    values[2, :4] = np.nan
    said = sentences_of(found_of(KEY, "more", points, values, 3), points)
    assert "(values are missing: compared in 2 or more of 6 replications)" in said[-1]

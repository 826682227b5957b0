"""Parts of figures in words, and which are shown."""

import hashlib
import json
import re
from dataclasses import replace
from html.parser import HTMLParser
from types import SimpleNamespace

import pytest

from opsim.kpi.parts import part_name
from opsim.report import render as contents
from opsim.report.page import HERE, StudyPage, Table, study_html
from opsim.report.page import StudySection as Section
from opsim.report.render import report_html, write_report
from opsim.report.sections import scenarios as forest
from opsim.report.sections import worker_timeline as days
from opsim.report.sections.common import is_shown, without_again
from opsim.report.sections.provenance import BOTH, RUN, YOURS, plotly_version
from opsim.report.sections.provenance import stress_des_section as section
from opsim.report.sections.provenance import stress_items as items_of
from tests.made import result as made_result
from tests.made.result import IMAGE, NAMES, SCRIPT, MadeResult, hostile, kpi, material, summary
from tests.made.result import page as page_of_parts

SECTIONS = ("summary", "figures-table", "states", "times", "movements", "made-up", "assumptions", "provenance")


class Page(HTMLParser):
    """The ids, tags and visible text of a page."""

    def __init__(self, text):
        super().__init__()
        self.ids, self.tags, self.text, self.addresses, self.inside = [], [], "", [], ""
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        self.inside = tag
        self.ids += [value for name, value in attrs if name == "id"]
        self.addresses += [value for name, value in attrs if name in ("src", "href")]

    def handle_data(self, data):
        self.text += "" if self.inside in ("script", "style") else data


def page(**other):
    return Page(made_result.page(summary(**other)))


def test_every_section_is_there_once():
    ids = page().ids
    assert [ids.count(section) for section in SECTIONS] == [1] * len(SECTIONS)
    assert len(set(ids)) == len(ids)


def test_sections_appear_only_when_there_is_something_to_say():
    ids = page(tasks=[], distributions=[], kpis=[kpi("throughput_per_h", unit="1/h", headline=True)]).ids
    assert not {"states", "times", "movements", "made-up"} & set(ids)


def test_the_page_asks_for_nothing_outside_itself():
    found = page()
    assert all(address.startswith(("#", "data:")) for address in found.addresses)
    assert "link" not in found.tags and "iframe" not in found.tags


def test_hostile_names_are_text_and_nothing_else():
    plain, harmed = page(), Page(made_result.page(hostile()))
    assert sorted(harmed.tags) == sorted(plain.tags)
    assert all(name in harmed.text for name in NAMES)


def test_only_the_two_scripts_of_the_report_may_run():
    text = made_result.page(hostile())
    policy = re.search(r'Content-Security-Policy" content="([^"]*)"', text)[1]
    assert (
        policy.startswith("default-src &#39;none&#39;; script-src &#39;sha256-")
        and "unsafe-inline" not in policy.split(";")[1]
    )
    assert policy.count("sha256-") == 2


def test_a_strip_stands_with_its_source_licence_recordings_and_people():
    found = page()
    assert "41 recordings of 6 people" in found.text and "Made recordings 2026 · Licence: public domain" in found.text
    assert any(address.startswith("data:image/svg+xml;base64,") for address in found.addresses)


def test_tasks_of_one_movement_share_a_strip():
    tasks = summary()["tasks"]
    both = [tasks[0], {**tasks[0], "task": "lift_again"}]
    found = page(tasks=both)
    assert found.tags.count("img") == 1 and "lift and lift_again" in found.text


def test_made_movements_are_not_passed_off_as_recordings():
    made = {**summary()["tasks"][0], "source": "synthetic, made by this project"}
    text = page(tasks=[made]).text
    assert "41 made repetitions of 6 made-up people: nobody was recorded" in text and "41 recordings" not in text


def test_times_without_recordings_are_said_to_be_made_up():
    assert page().text.count("given in the scenario") >= 2


def test_states_that_do_not_sum_to_one_carry_a_warning():
    kpis = [kpi("worker_states", "ana", "work", "share", 0.5, 0.01)]
    assert "The states of ana sum to 50.00 %" in page(kpis=kpis).text
    assert "do not trust" not in page().text


def test_one_replication_makes_a_report():
    kpis = [kpi("throughput_per_h", unit="1/h", mean=60.0, half_width=None, n=1, headline=True)]
    assert "one replication" in page(kpis=kpis, replications=1).text


def test_a_kpi_that_was_never_observed_makes_a_report():
    kpis = [kpi("time_in_system_s", mean=None, half_width=None, n=0, headline=True)]
    assert "no value in any replication" in page(kpis=kpis, distributions=[]).text


def test_the_provenance_is_that_of_the_manifest(tmp_path):
    manifest = {
        "python": "3.11.9",
        "packages": {"numpy": "2.4"},
        "libraries": {"moves": {"file": "m.npz", "sha256": "ab12"}},
    }
    made = material(summary(), tmp_path, manifest)
    path = write_report(made, tmp_path / "deep" / "report.html").path
    text = Page(path.read_text(encoding="utf-8")).text
    assert "numpy 2.4" in text and "ab12" in text and "3.11.9" in text


def test_the_report_is_below_five_megabytes():
    assert len(made_result.page(summary()).encode()) < 5e6


def test_the_figures_are_json_that_cannot_end_their_script():
    text = made_result.page(hostile())
    body = text.split('id="figures">', 1)[1].split("</script>", 1)[0]
    figures = json.loads(body)
    assert {"worker_states", "station_states"} <= set(figures)
    assert all(set(figure) == {"data", "layout"} for figure in figures.values())
    assert SCRIPT not in body


@pytest.mark.parametrize("asset", ["assets/plotly-cartesian.min.js"])
def test_the_bundle_is_the_one_its_licence_note_names(asset):
    digest = hashlib.sha256((HERE / asset).read_bytes()).hexdigest()
    assert digest in (HERE / "assets/plotly-cartesian.LICENSE.txt").read_text()


def test_the_page_names_the_version_of_the_bundle_that_is_in_it():
    head = (HERE / "assets/plotly-cartesian.min.js").read_text(encoding="utf-8")[:400]
    assert f"plotly.js (cartesian - minified) v{plotly_version()}" in head
    assert f"plotly.js {plotly_version()}" in page().text


def test_behind_every_task_stand_library_licence_recordings_and_people():
    text = page().text
    row = text[text.index("What stands behind every task") :]
    assert "libraries/moves.npz" in row and "41 recordings of 6 people: Made recordings 2026" in row
    assert "public domain" in row and "nobody: the scenario says so" in row


DAY = {"picture": b"<svg/>", "legend": [("#0072B2", "work")], "stretch": "5 min", "alt": "ana: work 50 %"}
DAY |= {"cut": False, "shifts": True, "more": 3}


def with_day(monkeypatch, **other):
    monkeypatch.setattr(days, "worker_timeline_section", lambda material: days.section_of({**DAY, **other}))
    return page()


def test_people_through_the_day_have_a_section_only_where_there_are_people(monkeypatch):
    assert "days" not in [*page().ids, *page().addresses]
    found = with_day(monkeypatch)
    assert found.ids.count("days") == 1 and found.addresses.count("#part-people") == 1
    assert "Each stretch of 5 min" in found.text and "3 more workers are not shown" in found.text
    assert "marks his shift" in found.text and "marks his shift" not in with_day(monkeypatch, shifts=False).text


def test_a_hostile_worker_in_the_words_of_a_picture_is_text_and_nothing_else(monkeypatch):
    plain, harmed = (with_day(monkeypatch, alt=alt) for alt in ("ana", SCRIPT + IMAGE))
    assert sorted(harmed.tags) == sorted(plain.tags)


def broken(material):
    raise OSError("the rows are gone")


def test_a_section_that_cannot_be_made_is_named_with_the_reason_and_costs_nothing_else(monkeypatch, tmp_path):
    monkeypatch.setattr(forest, "scenarios_section", broken)
    monkeypatch.setattr(days, "worker_timeline_section", broken)
    written = write_report(material(summary()), tmp_path / "report.html")
    assert written.contents.missing == [("the rows are gone", "scenarios, worker timeline")]
    found = Page(written.path.read_text(encoding="utf-8"))
    assert "This report lacks scenarios, worker timeline, which could not be made: the rows are gone" in found.text
    assert "provenance" in found.ids


def test_who_looks_for_the_mistake_sees_where_it_is(monkeypatch):
    monkeypatch.setattr(forest, "scenarios_section", broken)
    monkeypatch.setenv("OPSIM_TRACEBACK", "1")
    with pytest.raises(OSError, match="rows are gone"):
        report_html(material(summary()))


def test_a_mistake_of_ours_is_no_missing_section(monkeypatch):
    monkeypatch.setattr(forest, "scenarios_section", lambda material: material.no_such_thing)
    with pytest.raises(AttributeError):
        report_html(material(summary()))


def test_a_part_without_sections_is_neither_there_nor_linked():
    found = page(tasks=[], distributions=[], kpis=[])
    assert [part.id for part in contents.PARTS if part.id in found.ids] == ["part-figures", "part-making"]
    assert "#part-flow" not in found.addresses and "#part-making" in found.addresses


def test_every_link_leads_somewhere_and_no_id_stands_twice():
    found = page()
    assert {address[1:] for address in found.addresses if address.startswith("#")} <= set(found.ids)
    assert len(found.ids) == len(set(found.ids))


FATES = {"resumed": 0.5, "by_another": 0.0, "handed_over": 0.0}


def broken_off(subject, **per_h):
    return [kpi("interruptions_per_h", subject, part, "1/h", mean, 0.0) for part, mean in per_h.items()]


def test_parts_of_interruptions_are_in_plain_words_and_others_as_they_are():
    assert part_name("interruptions_per_h", "by_another") == "gone on with by another"
    assert part_name("station_states", "blocked") == "blocked" and part_name("interruptions_per_h", "") == ""


def test_a_part_that_is_nothing_everywhere_is_left_out_and_the_total_never():
    assert not is_shown("interruptions_per_h", "open", [{"mean": 0.0}, {"mean": None}])
    assert is_shown("interruptions_per_h", "open", [{"mean": 0.0}, {"mean": 0.1}])
    assert is_shown("interruptions_per_h", "", [{"mean": 0.0}]) and is_shown("stop_share", "jam", [{"mean": 0.0}])


def test_the_report_lists_of_interruptions_what_there_was():
    rows = [kpi("interruptions_per_h", unit="1/h", mean=0.5, half_width=0.0), *broken_off("", **FATES)]
    text = page_of_parts(summary(kpis=[*rows, *broken_off("weld", **FATES)]))
    assert text.count("gone on with by the same one") == 2 and "weld · gone on with by the same one" in text
    assert "by_another" not in text and "gone on with by another" not in text and "handed over" not in text


def test_nothing_of_a_figure_that_has_parts_alone_is_an_answer_and_the_unknown_none():
    for name in ("rest_allowance_share", "iso_11226_min_per_h", "exposure_gini"):
        assert is_shown(name, "murrell", [{"mean": 0.0}]) and not is_shown(name, "murrell", [{"mean": None}])
    rows = [kpi("iso_11226_min_per_h", "ana", "trunk", "min/h", 0.0, 0.0)]
    assert "Held beyond ISO 11226" in page_of_parts(summary(kpis=rows))


def test_what_there_is_at_most_is_left_out_where_it_is_what_there_is_at_least():
    rows = [
        kpi("rest_allowance_share", "ana", part, "share", mean)
        for part, mean in [("murrell", 0.1), ("murrell_at_most", 0.1), ("price", 0.1), ("price_at_most", 0.2)]
    ]
    alone = kpi("lifting_index", "lift", "at_most", "", 2.0)
    assert without_again([*rows, alone]) == [rows[0], rows[2], rows[3], alone]


def test_the_report_leaves_them_out_too():
    rows = [kpi("rula_mean", "ana", part, "", 3.0) for part in ("", "at_most")]
    text = page_of_parts(summary(kpis=[*rows, kpi("rula_p90", "ana", "", "", 3.0)]))
    assert "at most" not in text and "Other figures: bodies" in text and "Other figures: flow" not in text


def test_long_text_has_room_on_a_narrow_screen_and_short_text_and_numbers_take_none():
    table = Table(("who", "what", "why", "n"), [("ana", "w" * 20, "why " * 20, "1")], words=3)
    assert table.kinds == ["", "words", "sentence", "number"]
    page = study_html(StudyPage("Line", "sweep", (), (Section("Rows", table=table),)))
    assert '<td>ana</td><td class="words">' in page and '<td class="number">1</td>' in page


def test_a_page_says_scroll_sideways_only_where_a_browser_knows_that_there_is_more():
    page = study_html(StudyPage("Line", "sweep", (), ()))
    assert "display: var(--can-scroll, none)" in page and "animation-timeline: scroll(self inline)" in page


NUMBERS = [
    *("1.1", "1.2", "1.3", "2.1", "2.2", "2.3", "2.4", "2.5", "3.1", "3.2", "3.3", "3.4"),
    *("4.1", "4.2", "4.3", "5.1", "5.2", "5.3", "5.4", "6.1"),
]
"""The items of STRESS-DES, Monks et al. (2019), table 1."""
RESOLVED = {
    "products": {"pump": {"route": ["weld", ["press", "saw"]]}},
    "workers": {"ana": {}},
    "stations": {"weld": {}, "press": {}, "saw": {}},
    "flow": {"dispatch": "spt"},
    "release": {"kind": "poisson"},
}


def made(folder="nowhere", siblings=(), resolved=RESOLVED, **other):
    found = material(summary(**other), siblings=siblings)
    return replace(found, run=replace(found.run, loaded=SimpleNamespace(resolved=resolved)))


def said(material):
    return {item.number: item for item in items_of(material)}


def test_all_20_items_are_there_in_their_order_each_by_somebody():
    items = items_of(made())
    assert [item.number for item in items] == NUMBERS
    assert {item.by for item in items} == {RUN, BOTH, YOURS}
    assert all(item.said for item in items if item.by == RUN)


def test_what_a_run_cannot_know_is_left_to_who_reports_it():
    found = said(made())
    assert [number for number, item in found.items() if item.by == YOURS] == ["1.1", "3.2", "5.4"]


def test_what_it_knows_is_said():
    found = said(made(precision=[{"figure": "throughput_per_h", "wanted": 0.01}]))
    assert "20 replications, as many as it took for throughput_per_h within 1 %" in found["4.3"].said
    assert "Seed 7" in found["5.2"].said and "PCG64" in found["5.2"].said
    assert "pump: weld - press or saw" in found["2.2"].said and "waiting jobs by spt" in found["2.4"].said
    assert "workers ana (1)" in found["2.5"].said and "entry: release" in found["2.5"].said
    assert "the first 30.00 min do not count" in found["4.1"].said and "Made recordings 2026" in found["3.1"].said


def test_a_variant_says_in_what_it_differs_from_the_base(tmp_path):
    (tmp_path / "scenario.resolved.yaml").write_text("flow: {dispatch: fifo}\nworkers: {ana: {}}\n")
    base = MadeResult(summary(), tmp_path)
    found = material(summary(variant="quick"))
    found = replace(
        found,
        siblings={"base": base, "quick": found.result},
        run=replace(found.run, loaded=SimpleNamespace(resolved={"flow": {"dispatch": "spt"}, "workers": {"ana": {}}})),
    )
    assert said(found)["2.3"].said == "Against base: flow.dispatch fifo, now spt."
    assert "Variants run: base and quick" in said(found)["1.3"].said


def test_the_table_names_a_group_once():
    (table,) = (block for block in section(made()).blocks if block.kind == "grid")
    assert [row[0] for row in table.rows if row[0]] == [
        *("Objectives", "Logic", "Data", "Experimentation", "Implementation", "Code access")
    ]

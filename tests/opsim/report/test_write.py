import hashlib
import json
import re
from html.parser import HTMLParser

import pytest

from opsim.report import render as contents
from opsim.report.page import HERE
from opsim.report.render import report_html, write_report
from opsim.report.sections import scenarios as forest
from opsim.report.sections import worker_timeline as days
from opsim.report.sections.provenance import plotly_version
from tests import made_result
from tests.made_result import IMAGE, NAMES, SCRIPT, hostile, kpi, material, summary

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
    assert "made up" in page().text and "nobody measured them here" in page().text


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

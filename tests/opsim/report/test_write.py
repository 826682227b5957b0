import hashlib
import json
import re
from html.parser import HTMLParser

import pytest

from opsim.report.offline import HERE
from opsim.report.write import report_html, write_report
from tests.made_result import IMAGE, NAMES, SCRIPT, MadeResult, distribution, hostile, kpi, summary

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
    return Page(report_html(summary(**other), {}, {}))


def test_every_section_is_there_once():
    ids = page().ids
    assert [ids.count(section) for section in SECTIONS] == [1] * len(SECTIONS)
    assert len(set(ids)) == len(ids)


def test_sections_appear_only_when_there_is_something_to_say():
    ids = page(tasks=[], distributions=[], kpis=[kpi("throughput_per_h", unit="1/h", headline=True)]).ids
    assert not {"states", "times", "movements", "made-up"} & set(ids)


def test_the_page_asks_for_nothing_outside_itself():
    found = Page(report_html(summary(), {}, {"lift": b"<svg/>"}))
    assert all(address.startswith(("#", "data:")) for address in found.addresses)
    assert "link" not in found.tags and "iframe" not in found.tags


def test_hostile_names_are_text_and_nothing_else():
    plain, harmed = page(), Page(report_html(hostile(), {}, {}))
    assert sorted(harmed.tags) == sorted(plain.tags)
    assert all(name in harmed.text for name in NAMES)


def test_only_the_two_scripts_of_the_report_may_run():
    text = report_html(hostile(), {}, {})
    policy = re.search(r'Content-Security-Policy" content="([^"]*)"', text)[1]
    assert (
        policy.startswith("default-src &#39;none&#39;; script-src &#39;sha256-")
        and "unsafe-inline" not in policy.split(";")[1]
    )
    assert policy.count("sha256-") == 2


def test_a_strip_stands_with_its_source_licence_recordings_and_people():
    found = Page(report_html(summary(), {}, {"lift": b"<svg/>"}))
    assert "41 recordings of 6 people" in found.text and "Made recordings 2026 · Licence: public domain" in found.text
    assert any(address.startswith("data:image/svg+xml;base64,") for address in found.addresses)


def test_tasks_of_one_movement_share_a_strip():
    tasks = summary()["tasks"]
    both = [tasks[0], {**tasks[0], "task": "lift_again"}]
    found = Page(report_html(summary(tasks=both), {}, {"lift": b"<svg/>", "lift_again": b"<svg/>"}))
    assert found.tags.count("img") == 1 and "lift, lift_again" in found.text


def test_made_movements_are_not_passed_off_as_recordings():
    made = {**summary()["tasks"][0], "source": "synthetic, made by this project"}
    text = page(tasks=[made]).text
    assert "41 made repetitions of 6 made-up people: nobody was recorded" in text and "41 recordings" not in text


def test_times_that_are_all_the_same_are_said_and_not_drawn():
    same = distribution("duration_s", "press") | {"quantiles": {"0.05": 25.0, "0.5": 25.0, "0.95": 25.0}, "beyond": 0}
    found = page(distributions=[same])
    assert "always 25.00 s" in found.text and "duration_s-0" not in found.ids


def test_times_without_recordings_are_said_to_be_made_up():
    assert "made up" in page().text and "nobody measured them here" in page().text


def test_states_that_do_not_sum_to_one_carry_a_warning():
    kpis = [kpi("worker_states", "ana", "work", "share", 0.5, 0.01)]
    assert "The states of ana sum to 50.00 %" in page(kpis=kpis).text
    assert "do not trust" not in page().text


def test_more_than_twelve_histograms_leave_the_rest_to_the_table():
    found = page(distributions=[distribution("duration_s", f"task{i}") for i in range(15)])
    assert "3 more are in the table only" in found.text and "task14" in found.text
    assert "duration_s-11" in found.ids and "duration_s-12" not in found.ids


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
    (tmp_path / "manifest.json").write_text(json.dumps(manifest))
    path = write_report(MadeResult(summary(), tmp_path), tmp_path / "deep" / "report.html")
    text = Page(path.read_text(encoding="utf-8")).text
    assert "numpy 2.4" in text and "ab12" in text and "3.11.9" in text


def test_the_report_is_below_five_megabytes():
    assert len(report_html(summary(), {}, {}).encode()) < 5e6


def test_the_figures_are_json_that_cannot_end_their_script():
    text = report_html(hostile(), {}, {})
    body = text.split('id="figures">', 1)[1].split("</script>", 1)[0]
    assert set(json.loads(body)) == {
        "worker_states",
        "station_states",
        "time_in_system_s-0",
        "cycle_time_s-0",
        "duration_s-0",
    }
    assert SCRIPT not in body


@pytest.mark.parametrize("asset", ["assets/plotly-cartesian.min.js"])
def test_the_bundle_is_the_one_its_licence_note_names(asset):
    digest = hashlib.sha256((HERE / asset).read_bytes()).hexdigest()
    assert digest in (HERE / "assets/plotly-cartesian.LICENSE.txt").read_text()


def walks(worker="ana", source="Made walks 2026"):
    behind = {"source": source, "licence": "public domain", "n_sequences": 12, "n_workers": 4}
    walk = {"worker": worker, "picture": b"<svg/>", "words": "1.20 m/s, steps of 0.62 m"}
    return {"source": {"model": "emulator walking/walk", "library": "w.npz", **behind}, "walks": [walk], "more": 3}


def test_walking_has_a_section_only_where_it_has_postures():
    text = report_html(summary(), {}, {}, walks())
    assert text.count('id="walking"') == 1 and text.count('href="#walking"') == 1
    assert "ana: 1.20 m/s, steps of 0.62 m." in text and "3 more walk" in text and "12 recordings of 4 people" in text
    assert "walking" not in [*page().ids, *page().addresses]


def test_a_hostile_walker_is_text_and_nothing_else():
    plain, harmed = (Page(report_html(summary(), {}, {}, walks(*names))) for names in ((), (SCRIPT, SCRIPT)))
    assert sorted(harmed.tags) == sorted(plain.tags) and harmed.text.count(SCRIPT) >= 2


def days(more=0, **other):
    made = {"picture": b"<svg/>", "legend": [("#0072B2", "work")], "stretch": "5 min", "alt": "ana: work 50 %"}
    return {**made, "cut": False, "shifts": True, "more": more, **other}


def test_people_through_the_day_have_a_section_only_where_there_are_people():
    text = report_html(summary(), {}, {}, None, days(more=3))
    assert text.count('id="days"') == 1 and text.count('href="#days"') == 1
    assert "Each stretch of 5 min" in text and "3 more workers are not shown" in text and "marks his shift" in text
    assert "marks his shift" not in report_html(summary(), {}, {}, None, days(shifts=False))
    assert "days" not in [*page().ids, *page().addresses]


def test_a_hostile_worker_in_the_words_of_the_picture_is_text_and_nothing_else():
    plain, harmed = (Page(report_html(summary(), {}, {}, None, days(alt=alt))) for alt in ("ana", SCRIPT + IMAGE))
    assert sorted(harmed.tags) == sorted(plain.tags)

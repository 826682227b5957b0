from dataclasses import replace
from types import SimpleNamespace

from opsim.report.sections.provenance import BOTH, RUN, YOURS
from opsim.report.sections.provenance import stress_des_section as section
from opsim.report.sections.provenance import stress_items as items_of
from tests.made_result import MadeResult, material, summary

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

from opsim.report.sections.yamazumi import Bar, Look, bar_traces, in_hover
from tests.made_result import SCRIPT


def test_bars_of_one_look_are_one_trace():
    at_work, waits = Look("work", "#000000"), Look("waits", "#ffffff", pattern="/")
    traces = bar_traces([Bar(at_work, 0, 1, 2), Bar(waits, 0, 3, 1), Bar(at_work, 1, 4, 2.5)])
    assert [(trace["name"], trace["base"], trace["x"], trace["y"]) for trace in traces] == [
        ("work", [1, 4], [2, 2.5], [0, 1]),
        ("waits", [3], [1], [0]),
    ]
    assert "pattern" not in traces[0]["marker"] and traces[1]["marker"]["pattern"]["shape"] == "/"


def test_a_hostile_name_is_no_markup_and_fills_nothing_in():
    (trace,) = bar_traces([Bar(Look(SCRIPT, "#000000"), 0, 0, 1, SCRIPT, SCRIPT)])
    assert "<" not in trace["name"] + trace["text"][0] + trace["customdata"][0]
    assert "%{x}" not in in_hover("%{x}<b>") and "<" not in in_hover("<b>")


def test_a_pattern_shows_in_its_legend_too():
    looks = [Look("a", "#123456", pattern=pattern) for pattern in ("", "/", "\\", "x", ".")]
    assert len({look.swatch for look in looks}) == 5 and all("#123456" in look.swatch[0] for look in looks)

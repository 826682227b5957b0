"""Which rows of a run the console shows."""

from dataclasses import dataclass

import pytest

from opsim.cli.run import matters, print_results
from tests.made_result import kpi


@dataclass
class Made:
    summary: dict


def result(*rows):
    return Made({"kpis": list(rows), "replications": 2, "seed": 1, "confidence": 0.95})


def states(figure, subject, **shares):
    return [kpi(figure, subject, part, "share", share, 0.01, headline=True) for part, share in shares.items()]


def test_every_state_that_takes_more_than_a_twentieth_somewhere_is_shown(capsys):
    base = states("station_states", "press", work=0.2, blocked=0.0, setup=0.6, pickup=0.01, starved=0.19)
    wide = states("station_states", "press", work=0.2, blocked=0.0, setup=0.01, pickup=0.07, starved=0.72)
    print_results("made", {"base": result(*base), "wide": result(*wide)})
    shown = capsys.readouterr().out
    assert all(f"press {state}" in shown for state in ("work", "blocked", "setup", "pickup"))
    assert "starved" not in shown and "60.0 ± 1.0 %" in shown


def test_a_state_that_takes_little_everywhere_is_left_to_the_report(capsys):
    print_results("made", {"base": result(*states("station_states", "press", work=0.9, setup=0.05, down=0.01))})
    shown = capsys.readouterr().out
    assert "press work" in shown and "setup" not in shown and "down" not in shown


@pytest.mark.parametrize("part", ["setup", "walk", "held", "team", "tool"])
def test_of_workers_too(part):
    assert matters("worker_states", part, {"base": {"mean": 0.3}})
    assert not matters("worker_states", part, {"base": {"mean": 0.01}, "wide": {"mean": None}})


def test_idle_workers_are_what_the_shown_states_leave():
    assert not matters("worker_states", "wait", {"base": {"mean": 0.9}})


def test_of_work_broken_off_the_parts_there_are_in_any_variant_are_shown_in_plain_words(capsys):
    def rows(**per_h):
        found = [kpi("interruptions_per_h", "", "", "1/h", sum(per_h.values()), 0.0, headline=True)]
        return [
            *found,
            *(kpi("interruptions_per_h", "press", p, "1/h", v, 0.0, headline=True) for p, v in per_h.items()),
        ]

    some = {"base": result(*rows(by_another=0.0, open=0.0)), "wide": result(*rows(by_another=2.0, open=0.0))}
    print_results("made", some)
    shown = capsys.readouterr().out
    assert "press gone on with by another" in shown and "press not gone on with" not in shown
    print_results("made", {"base": some["base"]})
    assert "Work broken off" in (shown := capsys.readouterr().out) and "press" not in shown


def test_of_exposure_by_anything_what_there_is_at_least_is_shown_in_plain_words(capsys):
    def rows(kpi_, subject, **per_h):
        return [kpi(kpi_, subject, part, "min/h", mean, 0.1, headline=True) for part, mean in per_h.items()]

    by_task = rows("exposure_by_task", "lift", rula_from_5=3.0, rula_from_5_at_most=9.0, rula_from_7=0.0)
    everybody = rows("rula_from_5_min_per_h", "", at_most=9.0, worst=4.0)
    print_results("made", {"base": result(*by_task, *everybody)})
    shown = capsys.readouterr().out
    assert "lift RULA 5 or more" in shown and "RULA 5 or more, at most" not in shown and "RULA 7" not in shown
    assert "at most" in shown and "whoever has most" in shown


def test_at_most_is_shown_only_where_it_is_more_than_at_least_in_some_variant(capsys):
    def rows(ana, ben):
        found = [
            ("ana", "", 2.0),
            ("ana", "at_most", ana),
            ("ben", "", 3.0),
            ("ben", "at_most", ben),
            ("", "worst", 3.0),
        ]
        return [kpi("rula_from_5_min_per_h", of, part, "min/h", mean, 0.0, headline=True) for of, part, mean in found]

    print_results("made", {"base": result(*rows(2.0, 3.0)), "open": result(*rows(2.0, 5.0))})
    shown = capsys.readouterr().out
    assert "ben at most" in shown and "ana at most" not in shown and "whoever has most" in shown

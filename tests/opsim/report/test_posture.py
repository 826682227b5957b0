import pytest

from opsim.report.page import Words
from opsim.report.sections.postures import posture_section as section
from tests import made_result
from tests.made_result import SCRIPT, kpi, material, summary


def rows(worker="ana", measured=0.4, beyond=(0.5, 3.0)):
    shares = {"below_20": 0.2, "from_20_to_60": 0.1, "beyond_60": 0.05, "unmeasured": 0.35, "not_at_work": 0.3}
    found = [
        kpi("trunk_flexion_share", who, part, "share", at, 0.01) for who in ("", worker) for part, at in shares.items()
    ]
    found.append(kpi("posture_measured_share", unit="share", mean=measured, half_width=0.01, headline=True))
    for limit, mean in zip((60, 20), beyond):
        found.append(kpi(f"trunk_beyond_{limit}_min_per_h", worker, unit="min/h", mean=mean, half_width=0.1))
        found.append(
            kpi(f"trunk_beyond_{limit}_min_per_h", f"{worker}2", unit="min/h", mean=mean and mean / 2, half_width=0.1)
        )
    return found


def sentences(kpis):
    return [block.text for block in section(material(summary(kpis=kpis))).blocks if isinstance(block, Words)]


def said(**more):
    return " ".join(sentences(rows(**more)))


def page(*more):
    made = summary()
    return made_result.page({**made, "kpis": [*made["kpis"], *more]})


def test_the_section_is_there_only_where_postures_were_asked_for():
    assert 'id="bodies"' not in page() and 'id="bodies"' in page(*rows())
    assert section(material(summary())) is None


def test_each_worker_has_a_bar_whose_parts_sum_to_one():
    bars = section(material(summary(kpis=rows()))).charts["trunk_flexion_share"]["data"]
    assert len(bars) == 5 and sum(bar["x"][0] for bar in bars) == pytest.approx(1)
    assert all(bar["customdata"] == ["ana"] for bar in bars)


def test_the_sentences_name_who_is_most_bent_and_what_was_not_seen():
    assert "Trunk flexed 60° or more: ana for longest, 0.50 minutes of each hour (0.40 to 0.60)." in said()
    assert "40.0 % (39.0 to 41.0) of the time at work has a known posture. Nobody knows how bent the rest was" in said()
    assert "Nobody knows" not in said(measured=1.0)


def test_nobody_bent_and_nothing_measured_are_told_apart():
    assert "Trunk flexed 60° or more: seen of nobody." in said(beyond=(0.0, 3.0))
    assert said(measured=0.0, beyond=(None, None)).startswith("No task that was worked on has a body")


def test_shares_are_drawn_and_not_in_the_table_in_front():
    text = page(*({**row, "headline": True} for row in rows()))
    front = text[text.index('id="figures-table"') : text.index("<details>")]
    assert "Work whose posture is known" in front and "Time by trunk flexion" not in front


def test_a_hostile_worker_is_text_and_nothing_else():
    assert SCRIPT not in page(*rows(worker=SCRIPT))


WALKED = [
    kpi("walking_min_per_h", unit="min/h", mean=12.0, half_width=0.5),
    kpi("steps_per_h", unit="1/h", mean=1400.0, half_width=40.0),
    kpi("trunk_flexion_mean_deg", "", "walking", "deg", 4.2, 0.1),
    kpi("trunk_beyond_20_min_per_h", "ben", "together", "min/h", 9.0, 0.1),
]


def test_walking_is_said_where_it_has_postures():
    words = " ".join(sentences([*rows(), *WALKED]))
    assert "Walking takes 12.0 minutes of each hour of a worker (11.5 to 12.5), 1,400 (1,360 to 1,440) steps" in words
    assert "trunk flexed 4.20° (4.10 to 4.30) on average." in words
    assert "Walking takes" not in said()


def test_who_is_most_bent_is_said_of_work_alone():
    words = " ".join(sentences([*rows(), *WALKED]))
    assert "Trunk flexed 20° or more: ana for longest, 3.00" in words


def test_walking_is_said_too_where_no_work_has_a_body():
    words = sentences([*rows(measured=0.0, beyond=(None, None)), *WALKED])
    assert len(words) == 2 and words[0].startswith("No task that was worked on has a body")

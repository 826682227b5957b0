"""The ways that people walk, in a report."""

import re
from typing import NamedTuple
from xml.etree import ElementTree

import numpy as np
import pytest
from plans import loaded, ran

from emulator.skeleton import standard_skeleton
from opsim.report.page import Panels, Svg, Words, flat
from opsim.report.plot.body import COLOURS
from opsim.report.plot.posture import VIEWS, posture_svg, room_of, warm
from opsim.report.sections import spaghetti
from opsim.report.sections.postures import posture_section as section
from tests.made import result as made_result
from tests.made.result import SCRIPT, kpi, material, summary
from tests.opsim.ergonomics.bodies import bent, standing, turn
from tests.opsim.report.made_material import hostile, of_log, texts
from tests.opsim.study.layout.made_floor import FLOOR


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


SKELETON = standard_skeleton()
SVG = "{http://www.w3.org/2000/svg}"


class Few(NamedTuple):
    names: tuple
    parents: tuple


def without(*ends):
    """The skeleton without some joints at the ends of limbs, and a standing body of it."""
    kept = [j for j, name in enumerate(SKELETON.names) if not name.endswith(ends)]
    names = tuple(SKELETON.names[j] for j in kept)
    parents = tuple(kept.index(SKELETON.parents[j]) if SKELETON.parents[j] >= 0 else -1 for j in kept)
    return Few(names, parents), standing()[kept]


def colours(svg):
    """The fills of the limbs, torso and head."""
    root = ElementTree.fromstring(svg)
    return [path.get("fill") for path in root.iter("path") if path.get("paint-order")]


def test_every_part_is_drawn_in_the_colour_of_its_side():
    drawn = colours(posture_svg(standing(), SKELETON))
    assert len(drawn) == 18 and set(drawn) == set(COLOURS)


def test_parts_are_as_warm_as_the_points_they_bring():
    drawn = colours(posture_svg(bent(60), SKELETON, drives={"trunk": 2.0, "arms": 0.75}, side="left"))
    assert warm(2.0) == "#b0410b" == warm(9.0) and warm(0.0) == "#a9b0ba" == warm(-1.0)
    assert drawn.count(warm(2.0)) == 3 + 1 and drawn.count(warm(0.75)) == 2
    both = colours(posture_svg(bent(60), SKELETON, drives={"arms": 0.75}))
    assert both.count(warm(0.75)) == 4


def test_the_back_of_owas_is_the_trunk():
    assert colours(posture_svg(standing(), SKELETON, drives={"back": 2.0})).count(warm(2.0)) == 4


@pytest.mark.parametrize("view", VIEWS)
def test_place_and_heading_do_not_matter(view):
    body = bent(40, 10, 15)
    elsewhere = body @ turn([0, 0, 1], 130).T + np.array([5.0, -3.0, 1.0])
    here, there = (
        np.array(re.findall(r"-?\d+\.\d", posture_svg(body, SKELETON, view=view)), float) for body in (body, elsewhere)
    )
    assert np.allclose(here, there, atol=0.11)


def test_the_worse_arm_is_nearer_to_the_viewer():
    """From its own side a body that is bent forward looks right where that is the right one, else left."""
    heads = {}
    for side in ("left", "right"):
        svg = posture_svg(bent(80), SKELETON, view="side", side=side, drives={"neck": 2.0})
        disc = [path for path in ElementTree.fromstring(svg).iter("path") if path.get("fill") == warm(2.0)][-1]
        heads[side] = float(disc.get("d").split()[0][1:])
    assert heads["right"] > 130 > 90 > heads["left"]


def test_several_postures_have_one_scale():
    room = room_of([standing(), bent(90)], SKELETON)
    sizes = {posture_svg(body, SKELETON, room=room).partition(">")[0] for body in (standing(), bent(90))}
    assert len(sizes) == 1 and room.tall_m == pytest.approx(1.65 - 0.02 + 0.16)


def test_what_is_not_known_is_left_out():
    body = standing()
    body[SKELETON.names.index("left_hand")] = np.nan
    assert len(colours(posture_svg(body, SKELETON))) == 17 and "nan" not in posture_svg(body, SKELETON)
    few, joints = without("hand", "wrist", "head")
    assert len(colours(posture_svg(joints, few))) == 18 - 2 - 2 - 2


def test_a_body_without_hips_keeps_its_heading():
    few, joints = without("hip", "knee", "ankle", "toe")
    assert len(colours(posture_svg(joints, few))) > 5


def test_words_for_who_cannot_see_are_escaped():
    assert 'aria-label="a &lt;b&gt; &quot;c&quot;"' in posture_svg(standing(), SKELETON, label='a <b> "c"')


def test_a_load_is_in_the_hands():
    assert posture_svg(standing(), SKELETON, load_kg=8.0).count("#8a6b3d") == 5
    assert "#8a6b3d" not in posture_svg(standing(), SKELETON, load_kg=0.0)


PATHS = FLOOR.replace("layout:\n", "layout:\n  distance: paths\n  paths: [[p1, p2, p3, p4, p5], [door, p1]]\n")


def spaghetti_material(text=FLOOR):
    log, plan = ran(text)
    return of_log(log, plan, loaded(text))


@pytest.fixture(scope="module")
def found():
    return spaghetti.spaghetti_section(spaghetti_material())


def test_who_walks_most_and_which_way_is_said(found):
    first, second = (block.text for block in found.blocks[:2])
    assert first.startswith("ben walks most: ") and "ana least" in first
    assert "between saw and drill" in second or "between drill and pack" in second


def test_a_line_is_as_thick_as_it_is_walked_often(found):
    drawn = next(block for block in found.blocks if isinstance(block, Svg)).text
    lines = re.findall(r'stroke-width="([\d.]+)"[^>]*><title>[^<]*: ([\d.,]+) trips', drawn)
    often = [(float(trips), float(wide)) for wide, trips in lines]
    assert len(often) > 2 and sorted(often) == sorted(often, key=lambda one: (one[1], one[0]))


def test_each_worker_has_a_picture_and_the_table_has_all_ways(found):
    panels = next(block for block in found.blocks if isinstance(block, Panels))
    assert [one.title.split(",")[0] for one in panels.blocks] == ["ana", "ben"]
    table = found.blocks[-1]
    assert table.columns[2] == "trips an hour" and any(row[0] in ("saw – drill", "drill – saw") for row in table.rows)


def test_along_paths_trips_add_up_on_every_stretch():
    made = spaghetti_material(PATHS)
    found = spaghetti.spaghetti_section(made)
    drawn = next(block for block in found.blocks if isinstance(block, Svg)).text
    stretches = {
        title: float(trips) for title, trips in re.findall(r"<title>([^<:]*): ([\d.,]+) trips an hour</title>", drawn)
    }
    assert stretches and all("–" in title for title in stretches)
    assert not any("saw – drill" in title for title in stretches)  # p2, p3 and p4 lie between


def test_without_rows_or_walks_there_is_no_section():
    made = spaghetti_material()
    made.log = None
    assert spaghetti.spaghetti_section(made) is None
    alone = (
        FLOOR.replace("carried: true", "carried: false")
        .replace("home: door, ", "")
        .replace("ben: {like: ana, ", "ben: {like: ana, walk: 1 m/s, ")
    )
    one_place = alone.replace("at: p5", "at: p1").replace("at: p3", "at: p1")
    assert spaghetti.spaghetti_section(spaghetti_material(one_place)) is None


def test_hostile_names_do_no_harm():
    log, plan = ran(FLOOR)
    section = spaghetti.spaghetti_section(of_log(log, hostile(plan, SCRIPT), loaded(FLOOR)))
    svgs = [block.text for block in flat(section.blocks) if isinstance(block, Svg)]
    assert len(svgs) == 3 and not any("<script" in svg for svg in svgs) and SCRIPT[:8] in texts(section)

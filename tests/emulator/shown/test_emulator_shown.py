"""What a notebook shows of recordings and emulators: small, well-formed, and harmless whatever they are called."""

from dataclasses import replace
from xml.etree import ElementTree

import numpy as np
import pytest

from emulator import MotionLibrary
from emulator.synthetic.tasks import make
from opsim.shipped import shipped_folder

SCRIPT = "<script>window.harmed = 1</script>"


def looked_at(thing):
    html = thing._repr_html_()
    assert len(html.encode()) < 20_000
    tree = ElementTree.fromstring(f"<div>{html}</div>")
    tags = {one.tag.partition("}")[2] or one.tag for one in tree.iter()}
    assert tags <= {"div", "p", "table", "thead", "tbody", "tr", "th", "td", "svg", "path", "rect", "text", "title"}
    return " ".join(" ".join(tree.itertext()).split())


@pytest.fixture(scope="module")
def library():
    return MotionLibrary.load(shipped_folder() / "libraries" / "bench_work.npz")


def test_a_library_and_its_emulators_show_what_they_were_learned_from(library):
    words = looked_at(library)
    assert f"MotionLibrary: {len(library)} tasks." in words and all(task in words for task in library)
    model = library[library.tasks[0]]
    assert f"{model.task}: learned from {model.report.n_sequences} repetitions" in looked_at(model)


def test_showing_an_emulator_changes_no_luck(library):
    model, rng = library[library.tasks[0]], np.random.default_rng(3)
    before = rng.bit_generator.state
    assert looked_at(model) == looked_at(model) and rng.bit_generator.state == before


def test_performances_show_their_times_and_the_first_body(library):
    drawn = library[library.tasks[0]].sample(30, np.random.default_rng(1))
    words = looked_at(drawn)
    assert "30 of" in words and "and 10 more" in words and f"{drawn.duration_s[0]:.4g}" in words


def test_walking_is_shown_too():
    model = MotionLibrary.load(shipped_folder() / "libraries" / "walking.npz").only()
    assert "Performances: 1 of walk." in looked_at(model.typical())


def test_recorded_motions_show_whose_they_are():
    motions, _ = make("reach", 3, 2, seed=4)
    words = looked_at(motions)
    assert f"{len(motions)} repetitions" in words and motions.workers[0] in words
    assert motions.motions[0].name in looked_at(motions.motions[0])
    harmful = replace(motions, task=SCRIPT, motions=tuple(replace(one, worker=SCRIPT) for one in motions.motions))
    assert SCRIPT in looked_at(harmful) and SCRIPT in looked_at(harmful.motions[0])


def test_frames_have_a_row_each(library):
    pytest.importorskip("pandas")
    drawn = library[library.tasks[0]].sample(5, np.random.default_rng(1))
    frame = drawn.to_frame()
    assert frame.duration_s.tolist() == drawn.duration_s.tolist()
    assert list(frame.columns) == ["duration_s", *(f"{name}_s" for name in drawn.model.mark_names)]

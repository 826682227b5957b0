from types import SimpleNamespace

import numpy as np
import pytest

from opsim.report.motion.segmentation import draw_agreement


def validation():
    rng = np.random.default_rng(0)
    body, mean = (
        SimpleNamespace(person_icc=1 - 0.02 * size * rng.random(18), sem_deg=size * rng.exponential(2.0, (18, 14)))
        for size in (1, 2)
    )
    body.sem_deg[0, 0] = np.nan
    return SimpleNamespace(task="lift & <carry>", by_body=body, by_mean=mean)


def test_the_picture_says_both_means_and_the_paper_s(tmp_path):
    made = validation()
    text = draw_agreement(made, tmp_path / "icc.svg").read_text(encoding="utf-8")
    assert f"by body {made.by_body.person_icc.mean():.3f}" in text
    assert f"by body {np.nanmean(made.by_body.sem_deg):.2f}" in text
    assert "paper 0.91" in text and "paper 4.16" in text
    assert "lift &amp; &lt;carry&gt;" in text


def test_the_same_figures_give_the_same_bytes(tmp_path):
    one, two = (draw_agreement(validation(), tmp_path / name).read_bytes() for name in ("a.svg", "b.svg"))
    assert one == two


@pytest.mark.parametrize("value", [0.95, 0.0])
def test_people_who_are_all_alike_can_be_drawn(tmp_path, value):
    same = SimpleNamespace(person_icc=np.full(3, value), sem_deg=np.full((3, 2), value))
    drawn = draw_agreement(SimpleNamespace(task="t", by_body=same, by_mean=same), tmp_path / "alike.png")
    assert drawn.read_bytes().startswith(b"\x89PNG")

"""Variants that differ in nothing but ``run: variability``."""

from types import SimpleNamespace

import pytest

from opsim.report.sections.variability import switched_variants
from opsim.study.resolved_scenario import resolved_text

RUN = {"start": "Mon 06:00", "horizon": "12 h", "replications": 3, "seed": 11}


def made(folder, **variants):
    found = {}
    for name, (run, rest) in variants.items():
        (folder / name).mkdir()
        text = resolved_text({"opsim": 1, "name": "cell", "run": run, "layout": rest})
        (folder / name / "scenario.resolved.yaml").write_text(text, encoding="utf-8")
        found[name] = SimpleNamespace(folder=folder / name)
    return found


@pytest.mark.parametrize("last", [True, False])
def test_they_are_found_wherever_the_switch_stands(tmp_path, last):
    def run(switch):
        return {**RUN, "variability": switch} if last else {"variability": switch, **RUN}

    here = {"distance": "euclidean"}
    siblings = made(
        tmp_path,
        base=(RUN, here),
        alike=(run("within_only"), here),
        calm=(run("none"), here),
        elsewhere=(run("between_only"), {"distance": "rectilinear"}),
    )
    assert switched_variants(siblings, "base") == {"full": "base", "within_only": "alike", "none": "calm"}
    assert switched_variants(siblings, "calm") == {"none": "calm", "full": "base", "within_only": "alike"}
    assert switched_variants(siblings, "elsewhere") == {"between_only": "elsewhere"}


def test_a_variant_in_a_folder_of_another_name_has_none(tmp_path):
    siblings = made(tmp_path, base_old=(RUN, {}), calm=({**RUN, "variability": "none"}, {}))
    assert switched_variants(siblings, "base") == {}


def test_a_study_that_varies_it_is_no_switch(tmp_path):
    studies = {"vary": {"run.variability": ["none", "full"]}}
    siblings = made(tmp_path, base=(RUN, studies), other=({**RUN, "variability": "none"}, studies))
    assert switched_variants(siblings, "base") == {"full": "base", "none": "other"}

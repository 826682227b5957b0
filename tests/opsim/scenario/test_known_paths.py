from pathlib import Path

import pytest

from opsim.scenario.paths import step, top, words
from opsim.scenario.read import variant_trees
from opsim.shipped import shipped_folder

HERE = Path(__file__).parent
FILES = sorted([*shipped_folder().glob("*.yaml"), HERE / "everything.yaml", HERE / "good.yaml"])


def spot_at(root, path):
    spot = top(root)
    for part in path.split("."):
        spot = spot and step(root, spot, part)
    return spot


def leaves(value, path=()):
    if not isinstance(value, dict) or not value:
        yield path
        return
    for key, below in value.items():
        yield from leaves(below, (*path, key))


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_every_path_that_stands_in_a_right_scenario_is_known(file):
    for tree in variant_trees(file)[1].values():
        for path in leaves(tree.plain()):
            spot = top(tree)
            for part in path:
                if part == "opsim":
                    break
                assert part in words(tree, spot), path
                spot = step(tree, spot, part)
                assert spot is not None, path


def test_keys_that_are_not_written_are_known_too():
    root = variant_trees(HERE / "good.yaml")[1]["base"]
    for path in ("run.posture", "human.learning.rate", "stations.pack.breakdowns.jam.repair", "defaults.workers.walk"):
        assert spot_at(root, path) is not None
    assert spot_at(root, "stations.pack.sarvers") is None
    assert spot_at(root, "opsim") is None


def test_what_is_copied_by_like_and_defaults_shines_through():
    root = variant_trees(HERE / "good.yaml")[1]["base"]
    assert spot_at(root, "workers.ben.skills.pack").node.value == 1.1
    assert "like" in words(root, spot_at(root, "workers.ben"))

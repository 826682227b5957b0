import numpy as np
from plans import CELL, plan

from opsim.viewer.playback import with_walking
from opsim.viewer.pose import standing
from opsim.viewer.skeletons import tree_of

ALONE = """
opsim: 1
name: nobody here
run: {horizon: 1 h}
layout: {places: {here: [0 m, 0 m]}}
tasks: {cut: {fixed: 20 s, automatic: true}}
stations: {saw: {at: here, tasks: [cut], buffer: 1}}
products: {part: {route: [saw]}}
release: {kind: saturated}
"""


def stood(text):
    return standing(with_walking(plan(text))[0], 0)


def test_everybody_has_bones_of_the_skeleton_that_stands():
    found = stood(CELL)
    n_bones = len(tree_of(found.skeleton)[1]) - 1
    assert found.bone_m.shape == (3, n_bones) and np.all(found.bone_m >= 0)
    assert np.allclose(np.linalg.norm(found.directions, axis=1), 1)


def test_where_there_are_no_workers_nobody_stands():
    found = stood(ALONE)
    assert found.bone_m.shape == (0, 1)
    assert found.directions.shape == (1, 3) and np.isclose(np.linalg.norm(found.directions), 1)

"""What ``people_of`` finds, made by hand: for tests of what is shown of it."""

import numpy as np

from emulator.judge.people import ByCovariates, Icc, People, Told

NONE = [np.nan, np.nan]


def found(task="reach", known=((0.1, 0.2), (0.3, 0.2), (0.9, 0.9), NONE), told=True):
    """ana, twice, is foretold better by her own draws; ben, once judged, is not; cid has a repetition only."""
    names, trials = np.array(["ana", "ana", "ben", "cid"]), np.array(["r1", "r2", "r1", "r1"])
    covariates = ByCovariates((Told("height", "log duration", 0.5, 0.01, True),), ("vmax: changes",))
    return People(
        task=task,
        selection="all",
        source="a test",
        licence="MIT",
        names=names,
        trials=trials,
        iccs=(Icc("log duration", 0.5, -0.1, 0.9), Icc("pace score 1", np.nan, np.nan, np.nan)),
        known=np.array(known, float),
        pooled=np.full((4, 2), 0.5),
        new=np.array([[0.5, 1.0]] * 3 + [NONE]),
        told=covariates if told else ByCovariates((), ()),
    )

"""Takes and recordings: what flows between readers, cleaning and cutting."""

from dataclasses import replace

import numpy as np
import pytest

from emulator import read_motions
from emulator.recordings.npz import read_recording, write_recording
from emulator.recordings.take import Recording, Take
from emulator.skeleton import standard_skeleton
from emulator.synthetic.tasks import make


def recording(n=3):
    motions, _ = make("reach", 1, n)
    skeleton = motions.skeleton
    takes = [
        Take(
            skeleton.names, skeleton.parents, m.positions_m(world=True), 50.0, m.worker, m.trial,
            mark_frame={"touch": float(m.mark_s[0] * 50)}, covariates={"cov_correct": 1},
            contact=np.ones((len(m.time_s), 2), bool),
        )
        for m in motions.motions
    ]  # fmt: skip
    return Recording(tuple(takes), "made", "MIT", ("a note",))


def test_a_written_recording_is_read_again_to_the_bit(tmp_path):
    made = recording()
    gap = made.takes[0].positions_m.copy()
    gap[3:5, 2] = np.nan
    made = replace(made, takes=(replace(made.takes[0], positions_m=gap), *made.takes[1:]))
    write_recording(made, tmp_path / "a.npz")
    again = read_recording(tmp_path / "a.npz")
    assert (again.source, again.licence, again.notes) == ("made", "MIT", ("a note",))
    for one, other in zip(made.takes, again.takes):
        assert np.array_equal(one.positions_m, other.positions_m, equal_nan=True)
        assert np.array_equal(one.contact, other.contact)
        assert (one.names, one.parents, one.name, one.rate_hz) == (
            other.names,
            other.parents,
            other.name,
            other.rate_hz,
        )
        assert dict(one.mark_frame) == dict(other.mark_frame) and dict(one.covariates) == dict(other.covariates)


def test_the_same_recording_gives_the_same_bytes(tmp_path):
    for name in "ab":
        write_recording(recording(), tmp_path / f"{name}.npz")
    assert (tmp_path / "a.npz").read_bytes() == (tmp_path / "b.npz").read_bytes()


def test_a_written_recording_can_be_fitted_from(tmp_path):
    write_recording(recording(), tmp_path / "reach.npz")
    motions = read_motions(tmp_path / "reach.npz")
    assert (len(motions), motions.mark_names, motions.task) == (3, ("touch",), "reach")
    assert motions.skeleton == standard_skeleton()


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"rate_hz": float("nan")}, "expected a positive number"),
        ({"rate_hz": 0.0}, "expected a positive number"),
        ({"names": ("pelvis",)}, "positions must be"),
        ({"parents": (-1,)}, "21 names and 1 parents"),
        ({"contact": np.ones((2, 2), bool)}, "contact must be"),
    ],
)
def test_a_take_whose_parts_disagree_is_refused(change, said):
    with pytest.raises(ValueError, match=said):
        replace(recording(1).takes[0], **change)


def test_takes_that_are_not_alike_are_no_recording():
    made = recording(2)
    for change in ({"rate_hz": 25.0}, {"mark_frame": {}}, {"names": made.names[::-1]}):
        with pytest.raises(ValueError, match="w1/r2"):
            Recording((made.takes[0], replace(made.takes[1], **change)))
    with pytest.raises(ValueError, match="found none"):
        Recording(())

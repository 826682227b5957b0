"""Damaged BVH, ASF and AMC files: either a take of finite places, or a message with the file; never anything else."""

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings

from emulator.recordings import RecordingError
from emulator.recordings.amc import read_amc
from emulator.recordings.bvh import read_bvh, read_bvh_file
from emulator.recordings.bvh_write import write_bvh_file
from tests.emulator.recordings.bvh_texts import ARM, random_file, written
from tests.emulator.recordings.mutations import damaged
from tests.emulator.recordings.test_asf_amc import AMC, ASF, files

MANY = settings(max_examples=250, suppress_health_check=[HealthCheck.function_scoped_fixture])
TREE = random_file(np.random.default_rng(5), n_joints=5)[0]


def held(path, read):
    """Reads, or refuses in the way that is promised."""
    try:
        take = read(path)
    except RecordingError as error:
        assert str(error).startswith(str(path.parent)) and len(str(error)) < 20_000
        return None
    assert np.all(np.isfinite(take.positions_m)) and take.n_frames > 0 and len(set(take.names)) == len(take.names)
    return take


@MANY
@given(text=damaged(ARM.encode()) | damaged(TREE.encode()) | damaged(ARM.encode("utf-16")))
def test_a_damaged_bvh_file_is_read_or_refused(tmp_path, text):
    path = written(tmp_path, text)
    held(path, read_bvh)
    if held(path, lambda path: read_bvh(path, unit_m=0.01, up="y")):
        file = read_bvh_file(path)
        write_bvh_file(file, tmp_path / "b.bvh")
        assert np.array_equal(read_bvh_file(tmp_path / "b.bvh").values, file.values)


@MANY
@given(text=damaged(ASF.encode()))
def test_a_damaged_skeleton_is_read_or_refused(tmp_path, text):
    held(files(tmp_path, asf=text), read_amc)


@MANY
@given(text=damaged(AMC.encode()))
def test_a_damaged_amc_file_is_read_or_refused(tmp_path, text):
    held(files(tmp_path, amc=text), read_amc)


def test_a_flood_of_mistakes_is_told_in_twenty_lines(tmp_path):
    """Fuzzing found 200 numbers among the bones of a skeleton, and a message of 44 kB."""
    path = files(tmp_path, asf=ASF.replace("upper fore", "upper " + "1 " * 300_000))
    with pytest.raises(RecordingError) as caught:
        read_amc(path)
    assert len(str(caught.value).splitlines()) == 20
    path = written(tmp_path, ARM.replace("OFFSET 10 0 0", "CHANNELS 1 no\n" * 30_000))
    with pytest.raises(RecordingError) as caught:
        read_bvh(path)
    assert len(str(caught.value).splitlines()) == 20

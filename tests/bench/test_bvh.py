"""A BVH file of 100 MB: the answer is asserted first, then the ratio to plain numpy and to the PyPI package ``bvh``.

``bvh`` is only there where ``make bench-peers`` installed it.
"""

import tracemalloc
from functools import partial

import numpy as np
import pytest
from bench.cpu import best_s

from emulator.recordings.bvh import bvh_positions, read_bvh, read_bvh_file
from emulator.recordings.bvh_write import write_bvh
from emulator.synthetic.tasks import make

SIZE = 100e6
TIMES = "Frame Time: "


@pytest.fixture(scope="module")
def large(tmp_path_factory):
    """(path, frames of the motion in it): a made lift, written over and over."""
    path = tmp_path_factory.mktemp("bvh") / "large.bvh"
    write_bvh(make("lift", 1, 1)[0].motions[0], path)
    head, _, body = path.read_text().partition(TIMES)
    time, _, rows = body.partition("\n")
    n_frames, again = rows.count("\n"), int(SIZE / len(rows)) + 1
    with path.open("w") as file:
        file.write(head.replace(f"Frames: {n_frames}", f"Frames: {n_frames * again}") + TIMES + time + "\n")
        for _ in range(again):
            file.write(rows)
    yield path, n_frames
    path.unlink()


def plain_numpy(path):
    """What one would write: all words of the motion, split and made numbers."""
    rows = path.read_bytes().partition(TIMES.encode())[2].partition(b"\n")[2]
    return np.array(rows.split(), float)


def whole(path):
    """All joints through time in metres: more than the others give."""
    return read_bvh(path, unit_m=0.01, up="y")


def test_a_hundred_megabytes_against_plain_numpy(large):
    path, n_frames = large
    file = read_bvh_file(path)
    assert path.stat().st_size > SIZE and np.array_equal(file.values.ravel(), plain_numpy(path))
    assert np.array_equal(bvh_positions(file)[2][:n_frames], bvh_positions(file)[2][-n_frames:])
    numpy_s, values_s, joints_s = best_s(
        partial(plain_numpy, path), partial(read_bvh_file, path), partial(whole, path), rounds=2
    )
    print(f"\nBVH, 100 MB: numpy {numpy_s:.1f} s, ours x {numpy_s / values_s:.1f}, joints x {numpy_s / joints_s:.1f}")
    assert numpy_s / values_s > 5 and numpy_s / joints_s > 2


def test_a_hundred_megabytes_take_the_memory_of_their_values(large):
    path, _ = large
    size = read_bvh_file(path).values.nbytes
    values, joints = (_peak(partial(read, path)) / size for read in (read_bvh_file, whole))
    print(f"\nBVH, 100 MB: peak memory {values:.2f} x the values ({size / 1e6:.0f} MB), with joints {joints:.2f} x")
    assert values < 1.1 and joints < 3.5


def _peak(read):
    tracemalloc.start()
    read()
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    return peak


def test_a_hundred_megabytes_against_the_package_bvh(large):
    """It leaves the values as words; ours are numbers, and joints in metres."""
    bvh = pytest.importorskip("bvh", reason="bvh is not installed: make bench-peers")
    path, n_frames = large

    def theirs():
        with path.open() as file:
            return bvh.Bvh(file.read())

    read = theirs()
    file = read_bvh_file(path)
    assert read.get_joints_names() == list(file.names) and read.nframes == len(file.values)
    for frame in (0, n_frames + 1, len(file.values) - 1):
        assert np.array_equal(file.values[frame], [float(word) for word in read.frames[frame]])
    del read
    theirs_s, values_s, joints_s = best_s(theirs, partial(read_bvh_file, path), partial(whole, path), rounds=1)
    print(f"\nBVH, 100 MB: bvh {theirs_s:.1f} s, ours x {theirs_s / values_s:.0f}, joints x {theirs_s / joints_s:.0f}")
    assert theirs_s / joints_s > 5

import io
import tracemalloc
import zipfile

import numpy as np
import pytest

from emulator.archive import MemberError, open_members, read_member


def npy(array, **settings):
    stream = io.BytesIO()
    np.save(stream, array, **settings)
    return stream.getvalue()


def huge_npy(shape="(1000000000000,)"):
    """A small .npy whose header declares a million million numbers."""
    honest = npy(np.zeros(4))
    return honest.replace(b"(4,), }" + b" " * (len(shape) - 4), shape.encode() + b", }")


def archive(path, **members):
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as file:
        for name, content in members.items():
            file.writestr(f"{name}.npy", content)
    return path


def read(path, name="x", most_bytes=10**6):
    with open_members(path, most_bytes, 10) as file:
        return read_member(file, f"{name}.npy")


@pytest.mark.parametrize(
    "array",
    [
        np.arange(6.0).reshape(2, 3),
        np.asfortranarray(np.arange(6.0).reshape(2, 3)),
        np.array(["knee", "hip"]),
        np.array(5, dtype=">i4"),
        np.zeros((0, 3)),
        np.array([True, False]),
    ],
)
def test_an_array_comes_back_as_numpy_reads_it(tmp_path, array):
    found = read(archive(tmp_path / "a.npz", x=npy(array)))
    assert found.dtype == array.dtype and found.shape == array.shape and np.array_equal(found, array)
    assert found.flags.writeable


@pytest.mark.parametrize(
    "content, said",
    [
        (huge_npy(), "declares \\(1000000000000,\\) of float64, 8000000000000 bytes, and holds 32"),
        (huge_npy("(-2, -2)"), "declares"),
        (huge_npy("(9, 9)"), "declares \\(9, 9\\)"),
        (npy(np.zeros(4))[:-3], "declares"),
        (npy(np.array([{}], dtype=object), allow_pickle=True), "Python objects"),
        (b"\x93NUMPY\x09\x00", "version"),
        (b"nothing", "damaged"),
        (b"", "damaged"),
    ],
)
def test_a_hostile_array_is_refused_by_name(tmp_path, content, said):
    path = archive(tmp_path / "a.npz", x=content)
    tracemalloc.start()
    try:
        with pytest.raises(MemberError, match=rf"x\.npy.*{said}|x\.npy is damaged.*{said}"):
            read(path)
        assert tracemalloc.get_traced_memory()[1] < 5 * 10**6
    finally:
        tracemalloc.stop()


def test_a_file_that_unpacks_to_too_much_is_refused_unread(tmp_path):
    path = archive(tmp_path / "bomb.npz", x=npy(np.zeros(10**6)))
    assert path.stat().st_size < 20_000
    with pytest.raises(MemberError, match="8 MB, expected at most 10 and"):
        read(path)


def test_a_file_that_lies_about_its_size_is_read_no_further_than_it_says(tmp_path):
    content = npy(np.zeros(4 * 10**6))
    path = archive(tmp_path / "liar.npz", x=content)
    raw = path.read_bytes().replace(len(content).to_bytes(4, "little"), (160).to_bytes(4, "little"))
    path.write_bytes(raw)
    tracemalloc.start()
    try:
        with pytest.raises(MemberError, match="damaged"):
            read(path)
        assert tracemalloc.get_traced_memory()[1] < 5 * 10**6
    finally:
        tracemalloc.stop()


def test_a_missing_member_is_a_key_error(tmp_path):
    with pytest.raises(KeyError):
        read(archive(tmp_path / "a.npz", x=npy(np.zeros(1))), "y")

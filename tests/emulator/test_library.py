import io
import json
import tracemalloc
import zipfile

import numpy as np
import pytest

from emulator.archive import FORMAT, MemberError, open_members, read_member
from emulator.byte_planes import from_planes
from emulator.model.emulator import SCHEMES, MotionEmulator
from emulator.model.library import LibraryError, MotionLibrary, file_sha256, read_header
from tests.emulator.fitted import made, motions_of, recorded


@pytest.fixture(scope="module")
def library():
    reach, walk = (motions_of(task).subset(np.arange(0, 40, 2)) for task in ("reach", "walk"))
    emulators = (MotionEmulator.fit(one, scheme=scheme) for one, scheme in zip((reach, walk), SCHEMES[1:]))
    return MotionLibrary.of(*emulators, command="made by a test", notes=("two tasks",))


@pytest.fixture
def saved(library, tmp_path):
    path = tmp_path / "moves.npz"
    library.save(path)
    return path


def changed(path, change):
    """The file with members changed by ``change(name, content) -> content or None to leave the member out``."""
    with zipfile.ZipFile(path) as file:
        members = {name: file.read(name) for name in file.namelist()}
    with zipfile.ZipFile(path, "w") as file:
        for name, content in members.items():
            content = change(name, content)
            if content is not None:
                file.writestr(name, content)
    return path


def with_header(path, change):
    def edit(name, content):
        if name != "header.npy":
            return content
        header = json.loads(np.load(io.BytesIO(content)).tobytes().decode())
        return npy(np.frombuffer(json.dumps(change(header)).encode(), np.uint8))

    return changed(path, edit)


def test_a_loaded_model_draws_what_the_saved_one_draws(library, saved):
    for task, emulator in MotionLibrary.load(saved).items():
        one, two = (m.sample(20, np.random.default_rng(3)) for m in (emulator, library[task]))
        assert one.duration_s.tobytes() == two.duration_s.tobytes()
        assert one.mark_s.tobytes() == two.mark_s.tobytes()
        assert (
            np.abs(one.positions_m(n_times=9) - two.positions_m(n_times=9)).max() < 1e-12
        )  # BLAS: by where arrays lie
        assert emulator.report == library[task].report
        assert emulator.workers == library[task].workers


def test_saving_what_was_loaded_gives_the_same_bytes(saved, tmp_path):
    MotionLibrary.load(saved).save(tmp_path / "again.npz")
    assert file_sha256(saved) == file_sha256(tmp_path / "again.npz")


def test_an_emulator_saves_and_loads_itself(tmp_path):
    made("lift")[1].save(tmp_path / "lift.npz")
    assert MotionEmulator.load(tmp_path / "lift.npz").task == "lift"


def test_one_task_cannot_be_loaded_from_a_library_of_two(saved):
    with pytest.raises(LibraryError, match="2 tasks"):
        MotionEmulator.load(saved)


def test_a_recorded_class_of_another_shape_survives(tmp_path):
    emulator = MotionEmulator.fit(recorded("shoulder_scaption"), scheme=SCHEMES[-1])
    emulator.save(tmp_path / "x.npz")
    again = MotionEmulator.load(tmp_path / "x.npz")
    assert again.report.source.startswith("UI-PRMD")
    assert (tmp_path / "x.npz").stat().st_size < 600_000
    one, two = (m.sample(8, np.random.default_rng(0), worker="s02").mark_s for m in (emulator, again))
    assert one.tobytes() == two.tobytes()


def test_the_header_is_read_without_the_arrays(saved):
    header = read_header(changed(saved, lambda name, content: content if name == "header.npy" else b"rubbish"))
    assert header["command"] == "made by a test"
    assert list(header["tasks"]) == ["reach", "walk"]
    assert header["tasks"]["walk"]["report"]["n_workers"] == 5


def test_nothing_is_left_beside_the_library(saved):
    assert [p.name for p in saved.parent.iterdir()] == ["moves.npz"]


def test_an_unknown_task_is_answered_with_the_nearest(library):
    with pytest.raises(LibraryError, match="did you mean 'reach'"):
        library["reech"]


def test_two_libraries_become_one(library):
    merged = library.merge(MotionLibrary.of(made("lift")[1], command="another"))
    assert merged.tasks == ("reach", "walk", "lift")
    assert merged.command == "made by a test; another"


def test_a_task_is_not_overwritten_in_silence(library):
    with pytest.raises(LibraryError, match="already"):
        library.add(library["walk"])


@pytest.mark.parametrize("content", [b"", b"not a zip at all", b"PK\x03\x04 and then nothing"])
def test_what_is_no_archive_is_refused(tmp_path, content):
    (tmp_path / "x.npz").write_bytes(content)
    with pytest.raises(LibraryError, match="not a motion library"):
        MotionLibrary.load(tmp_path / "x.npz")


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(LibraryError, match=r"gone\.npz: no such file"):
        MotionLibrary.load(tmp_path / "gone.npz")


def test_recordings_are_no_library(tmp_path):
    np.savez(tmp_path / "x.npz", positions=np.zeros((3, 2, 3)))
    with pytest.raises(LibraryError, match="not a motion library"):
        MotionLibrary.load(tmp_path / "x.npz")


@pytest.mark.parametrize("share", [0.1, 0.5, 0.9, 0.999])
def test_a_truncated_library_is_refused(saved, share):
    content = saved.read_bytes()
    saved.write_bytes(content[: int(share * len(content))])
    with pytest.raises(LibraryError):
        MotionLibrary.load(saved)


def test_a_flipped_byte_is_found(saved):
    content = bytearray(saved.read_bytes())
    content[len(content) // 2] ^= 0xFF
    saved.write_bytes(content)
    with pytest.raises(LibraryError):
        MotionLibrary.load(saved)


def test_a_pickle_is_never_opened(saved):
    class Trap:
        def __reduce__(self):
            return (pytest.fail, ("the pickle was opened",))

    trap = npy(np.array([Trap()], dtype=object), allow_pickle=True)
    with pytest.raises(LibraryError, match=r"walk/centre\.npy holds Python objects"):
        MotionLibrary.load(changed(saved, lambda name, content: trap if name == "walk/centre.npy" else content))


def test_a_number_that_is_none_is_refused(saved):
    poison = npy(np.array([np.nan]))
    with pytest.raises(LibraryError, match="finite"):
        MotionLibrary.load(changed(saved, lambda name, content: poison if name == "walk/spread.npy" else content))


def test_a_missing_array_is_named(saved):
    with pytest.raises(LibraryError, match="walk/centre"):
        MotionLibrary.load(changed(saved, lambda name, content: None if name == "walk/centre.npy" else content))


def test_an_array_of_wrong_shape_is_named(saved):
    wrong = npy(np.zeros((3, 3)))
    with pytest.raises(LibraryError, match=r"moves\.npz: array walk/centre: found \(3, 3\), expected \(\d+,\)"):
        MotionLibrary.load(changed(saved, lambda name, content: wrong if name == "walk/centre.npy" else content))


def test_a_library_of_another_version_is_refused(saved):
    with pytest.raises(LibraryError, match="version 99"):
        MotionLibrary.load(with_header(saved, lambda header: header | {"version": 99}))


@pytest.mark.parametrize(
    "change",
    [
        lambda header: [],
        lambda header: header | {"format": "something else"},
        lambda header: {"format": FORMAT, "version": 1},
        lambda header: header | {"tasks": {"walk": {}}},
        lambda header: header | {"tasks": 7},
        lambda header: header | {"tasks": {"walk": header["tasks"]["walk"] | {"sizes": [1, 2]}}},
        lambda header: header | {"tasks": {"walk": header["tasks"]["walk"] | {"n_times": "many"}}},
        lambda header: header | {"tasks": {"walk": header["tasks"]["walk"] | {"margin_slopes": [-1, 0]}}},
        lambda header: header | {"tasks": {"walk": header["tasks"]["walk"] | {"report": {"task": "walk"}}}},
    ],
)
def test_a_hostile_header_is_refused(saved, change):
    with pytest.raises(LibraryError):
        MotionLibrary.load(with_header(saved, change))


def test_an_archive_that_unpacks_to_too_much_is_refused(tmp_path, monkeypatch, saved):
    monkeypatch.setattr("emulator.archive.MAX_BYTES", 10_000)
    with pytest.raises(LibraryError, match="larger"):
        MotionLibrary.load(saved)


def less(rows):
    """A change of the arrays of these names that leaves out their last row."""
    return lambda name, content: npy(np.load(io.BytesIO(content))[:-1]) if name in rows else content


@pytest.mark.parametrize("part", ["within_factor", "between_factor", "effects", "posture_planes", "pace_mean"])
def test_a_row_cut_off_any_array_is_named_with_file_task_and_shapes(saved, part):
    with zipfile.ZipFile(saved) as file:
        shape = np.load(io.BytesIO(file.read(f"reach/{part}.npy"))).shape
    with pytest.raises(LibraryError) as error:
        MotionLibrary.load(changed(saved, less([f"reach/{part}.npy"])))
    found = (shape[0] - 1, *shape[1:])
    assert str(error.value) == f"{saved}: array reach/{part}: found {found}, expected {shape}"


def test_all_arrays_of_wrong_shape_are_named_at_once(saved):
    with pytest.raises(LibraryError, match=r"(?s)reach/centre.*walk/spread.*walk/margin0_z"):
        MotionLibrary.load(changed(saved, less(["reach/centre.npy", "walk/spread.npy", "walk/margin0_z.npy"])))


@pytest.mark.parametrize("part", ["within_factor", "between_factor"])
def test_a_row_cut_off_a_library_of_before_that_says_no_shapes_is_found(saved, part):
    with_header(saved, lambda header: {key: value for key, value in header.items() if key != "shapes"})
    assert MotionLibrary.load(saved).tasks == ("reach", "walk")
    with pytest.raises(LibraryError, match=f"walk/{part}: the squares"):
        MotionLibrary.load(changed(saved, less([f"walk/{part}.npy"])))


def test_curves_of_a_library_of_before_are_read_as_they_were(saved):
    """Its curves were written as steps along time, components x times x channels."""
    kept = MotionLibrary.load(saved)
    with zipfile.ZipFile(saved) as file:
        members = {name: file.read(name) for name in file.namelist()}
    for name in [name for name in members if name.endswith(("posture_planes.npy", "root_planes.npy"))]:
        whole = from_planes(np.load(io.BytesIO(members.pop(name)))).transpose(0, 2, 1)
        steps = np.diff(whole, axis=1, prepend=np.zeros_like(whole[:, :1]))
        members[name.replace("_planes", "_whole")] = npy(steps)
    with zipfile.ZipFile(saved, "w") as file:
        for name, content in members.items():
            file.writestr(name, content)
    with_header(saved, lambda header: {key: value for key, value in header.items() if key != "shapes"})
    again = MotionLibrary.load(saved)
    for task in kept:
        assert again[task].posture.basis.tobytes() == kept[task].posture.basis.tobytes()
        assert again[task].root.mean.tobytes() == kept[task].root.mean.tobytes()


def test_a_library_of_before_has_one_floor_for_all_and_does_not_hold_bodies_up(saved):
    with zipfile.ZipFile(saved) as file:
        members = {name: file.read(name) for name in file.namelist() if "strays" not in name}
    for name in [name for name in members if name.endswith("footing_lowest.npy")]:
        del members[name]
        members[name.replace("lowest", "floor")] = npy(np.array([[0.1, 0.02], [0.1, 0.03]]))
    with zipfile.ZipFile(saved, "w") as file:
        for name, content in members.items():
            file.writestr(name, content)

    def before(header):
        tasks = {task: own | {"floor": -0.01} for task, own in header["tasks"].items()}
        return {key: value for key, value in header.items() if key != "shapes"} | {"tasks": tasks}

    with_header(saved, before)
    for model in MotionLibrary.load(saved).values():
        footing = model.footing
        assert np.all(footing.floor == -0.01) and np.all(footing.foot_floor == [[0.1, 0.02], [0.1, 0.03]])
        assert np.all(footing.strays == np.inf) and len(footing.floor) == len(footing.postures)


def test_an_exponent_beyond_all_numbers_is_refused(saved):
    def wild(name, content):
        return (
            npy(np.full_like(np.load(io.BytesIO(content)), 32767)) if name == "walk/posture_exponent.npy" else content
        )

    with pytest.raises(LibraryError, match="exponents"):
        MotionLibrary.load(changed(saved, wild))


def test_a_reference_posture_that_is_none_is_refused(tmp_path):
    saved = tmp_path / "walk.npz"
    MotionEmulator.fit(motions_of("walk").subset(np.arange(0, 40, 4)), scheme=SCHEMES[-1]).save(saved)

    def nothing(name, content):
        return npy(np.zeros_like(np.load(io.BytesIO(content)))) if name == "walk/reference.npy" else content

    with pytest.raises(LibraryError, match="walk/reference: found vectors of another length"):
        MotionLibrary.load(changed(saved, nothing))


def test_an_array_that_declares_more_than_it_holds_is_refused(saved):
    with pytest.raises(LibraryError, match=r"moves\.npz: walk/centre\.npy is damaged: it declares \(1000000000000,\)"):
        MotionLibrary.load(changed(saved, lambda name, content: huge_npy() if name == "walk/centre.npy" else content))


def test_a_library_that_cannot_be_written_is_named_by_its_own_name_and_leaves_nothing(library, tmp_path):
    (tmp_path / "folder.npz").mkdir()
    for path in (tmp_path / "folder.npz", tmp_path / "nowhere" / "x.npz"):
        with pytest.raises(OSError) as error:
            library.save(path)
        assert error.value.filename == str(path) and ".part" not in str(error.value)
    assert [path.name for path in tmp_path.iterdir()] == ["folder.npz"]


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

import numpy as np
import pytest
import simpy

from opsim import Worker
from opsim.libraries import load_library
from opsim.performance import Drawn
from opsim.results import Result, events_name, lacking_rows, read_object
from opsim.shipped import shipped_folder
from opsim.streams import stream
from opsim.tasks import Fixed
from opsim.worker_effects import worker_effect


def result(folder, n, there):
    (folder / "events").mkdir()
    for number in there:
        (folder / "events" / events_name(number)).touch()
    return Result(folder, {"replications": n})


@pytest.mark.parametrize(
    ("there", "said"),
    [
        ((0, 1, 2), ""),
        ((0, 1, 2, 3), ""),
        ((), "no rows of events here, expected events/replication_00000.parquet; run it again"),
        ((1, 2), "found no rows of replication 0, expected 0 to 2"),
        ((1,), "found no rows of replication 0, 2, expected 0 to 2"),
        ((0, 1, 3), "found no rows of replication 2, expected 0 to 2"),
    ],
)
def test_replications_whose_rows_are_gone_are_named(tmp_path, there, said):
    found = lacking_rows(result(tmp_path, 3, there))
    assert said in found and bool(said) == bool(found)


@pytest.mark.parametrize("written", [b"{\n", b"\xff\xfe", b"", b"[]"])
def test_a_file_that_is_no_json_object_is_named(tmp_path, written):
    (tmp_path / "manifest.json").write_bytes(written)
    with pytest.raises(ValueError, match=r"manifest\.json: .*the manifest of a run"):
        read_object(tmp_path / "manifest.json", "the manifest of a run")


def test_an_object_is_read_as_it_was_written(tmp_path):
    (tmp_path / "x.json").write_text('{"a": [1, "é"]}', encoding="utf-8")
    assert read_object(tmp_path / "x.json", "anything") == {"a": [1, "é"]}


LIBRARY = load_library(shipped_folder() / "libraries" / "public_movements.npz")


def performed(stop_s=None, *, rating=1.0, n=3):
    """The n-th squat of ana; with ``stop_s`` its two pieces, stopped after so many seconds."""
    env = simpy.Environment()
    worker = Worker(env, "ana", LIBRARY, seed=7, rating=rating)

    def story():
        for _ in range(n - 1):
            yield worker.perform("deep_squat")
        doing = worker.perform("deep_squat")
        if stop_s is None:
            return (yield doing)
        yield env.timeout(stop_s)
        doing.interrupt()
        first = yield doing
        return first, (yield worker.resume(first))

    return env.run(env.process(story()))


@pytest.fixture(scope="module")
def block():
    """The emulator's own block that the performances of ana come from."""
    squat = LIBRARY["deep_squat"]
    effect = worker_effect(squat, "deep_squat", "ana", 7, 0)
    return squat.sample(64, stream(7, 0, "duration", "deep_squat", "ana", 0), worker=effect)


@pytest.mark.parametrize("what", ["directions", "positions_m", "root_m"])
@pytest.mark.parametrize("rating", [1.0, 1.1])
def test_a_body_decoded_alone_is_that_of_the_emulator_s_block(what, rating, block):
    alone = getattr(performed(rating=rating), what)(n_times=31)
    assert np.allclose(alone, getattr(block, what)(n_times=31)[2], rtol=0, atol=1e-10)


def test_the_pieces_of_a_performance_are_the_path_of_the_whole_cut_in_two(block):
    first, rest = performed(1.0)
    whole = block[2].positions_m(n_times=101)[0]
    cut = 1.0 / first.duration_s
    assert first.progress_to == pytest.approx(cut) and rest.progress_from == first.progress_to
    assert np.allclose(first.positions_m()[0], whole[0], atol=1e-10)
    assert np.allclose(rest.positions_m()[-1], whole[-1], atol=1e-10)
    assert np.allclose(first.positions_m()[-1], rest.positions_m()[0], atol=1e-10)


def test_times_asked_for_are_seconds_of_work_at_the_worker_s_own_pace(block):
    quick = performed(rating=1.25)
    times_s = np.linspace(0, quick.duration_s, 9)
    assert np.allclose(quick.positions_m(times_s=times_s), block[2].positions_m(n_times=9)[0], atol=1e-10)
    assert quick.mark_s == pytest.approx(block.mark_s[2] / 1.25, abs=1e-5)
    assert 0 < quick.mark_s[0] < quick.duration_s


def test_the_skeleton_names_the_joints_of_the_positions():
    squat = performed()
    height_m = squat.positions_m()[:, squat.skeleton.index("pelvis"), 2]
    assert height_m[0] - height_m.min() > 0.3


class Whole:
    """Performances that know no single row: the seam does not ask for it."""

    def __init__(self, block):
        self.duration_s, self.mark_s, self.positions_m = block.duration_s, block.mark_s, block.positions_m


def test_a_block_that_cannot_be_cut_into_rows_is_decoded_whole(block):
    alone, whole = Drawn(block, 5), Drawn(Whole(block), 5)
    assert np.allclose(alone.decoded("positions_m", n_times=7), whole.decoded("positions_m", n_times=7), atol=1e-10)


def test_a_time_without_a_body_says_so():
    env = simpy.Environment()
    done = env.run(Worker(env, "ana", {"fold": Fixed(1.0)}).perform("fold"))
    assert done.skeleton is None and done.mark_s == ()
    for what in (done.directions, done.positions_m, done.root_m):
        with pytest.raises(ValueError, match="no postures"):
            what()


def test_a_performance_is_frozen_and_equal_to_itself_drawn_again():
    one, two = performed(), performed()
    assert one == two and hash(one) == hash(two) and one.drawn is not two.drawn
    with pytest.raises(AttributeError):
        one.end_s = 0.0

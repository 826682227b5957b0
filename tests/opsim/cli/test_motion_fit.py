"""``opsim motion fit``: every mistake at once, and no finished task is lost when another one fails or is stopped.

``opsim motion fit --cyclic``: from recorded walks to walking of any length, drawn and shown.

``opsim motion fit`` on recordings that are wrong: refused with place, found and expected, or fitted with a note.
"""

import shutil
from types import SimpleNamespace

import numpy as np
import pytest

from emulator import MotionEmulator, MotionLibrary
from emulator.model.emulator import MotionEmulator as MotionEmulator_of_motion_bad_sets
from emulator.model.library import MotionLibrary as MotionLibrary_of_motion_fit_cyclic
from emulator.recordings.npz import write_recording
from emulator.synthetic.walking import make_walks
from opsim.cli.motion.family import _rows
from opsim.shipped import shipped_folder
from tests.opsim.cli.calls import one_person, opsim

BENCH = shipped_folder() / "libraries" / "bench_work.npz"
QUICK = ("--n-components", 2, "--n-times", 31)


@pytest.fixture(scope="module")
def recorded(tmp_path_factory):
    """A folder with the same six reaches as recordings of the tasks a, b and c."""
    folder = tmp_path_factory.mktemp("recorded")
    assert opsim("motion", "sample", BENCH, "reach", "-n", 6, "--fps", 20, "-o", folder / "a.npz")[0] == 0
    for task in "bc":
        shutil.copy(folder / "a.npz", folder / f"{task}.npz")
    return folder


def fails(monkeypatch, task, error):
    """A fit of ``task`` raises ``error``; others are as ever."""
    true = MotionEmulator.fit

    def fit(motions, **how):
        if motions.task == task:
            raise error
        return true(motions, **how)

    monkeypatch.setattr(MotionEmulator, "fit", fit)


def fitted(recorded, out):
    return opsim("motion", "fit", *(recorded / f"{task}.npz" for task in "abc"), "-o", out, *QUICK)


def test_ctrl_c_keeps_the_finished_tasks_and_says_which_are_missing(recorded, tmp_path, monkeypatch):
    fails(monkeypatch, "b", KeyboardInterrupt())
    out = tmp_path / "new" / "lib.npz"
    code, _, complaint = fitted(recorded, out)
    assert code == 130 and complaint.splitlines()[-1] == f"stopped; {out} holds a, not b, c"
    assert MotionLibrary.load(out).tasks == ("a",)


def test_a_task_that_fails_takes_nothing_from_the_others(recorded, tmp_path, monkeypatch):
    fails(monkeypatch, "b", ValueError("b: something odd"))
    out = tmp_path / "lib.npz"
    code, shown, complaint = fitted(recorded, out)
    assert code == 2 and complaint.splitlines()[-2:] == ["b: something odd", f"{out} holds a, c, not b"]
    assert MotionLibrary.load(out).tasks == ("a", "c") and "library: " in shown


def test_a_mistake_of_ours_keeps_the_finished_tasks_too(recorded, tmp_path, monkeypatch):
    fails(monkeypatch, "c", ZeroDivisionError("ours"))
    with pytest.raises(AssertionError, match="ours"):
        fitted(recorded, tmp_path / "lib.npz")
    assert MotionLibrary.load(tmp_path / "lib.npz").tasks == ("a", "b")


@pytest.mark.parametrize(
    "error, code, said",
    [(KeyboardInterrupt(), 130, "stopped; nothing was finished"), (ValueError("odd"), 2, "a: odd")],
)
def test_where_nothing_was_finished_no_file_and_no_folder_are_left(recorded, tmp_path, monkeypatch, error, code, said):
    fails(monkeypatch, "a", error)
    found, _, complaint = opsim("motion", "fit", recorded / "a.npz", "-o", tmp_path / "new" / "deep" / "l.npz", *QUICK)
    assert found == code and complaint.splitlines()[-1] == said and list(tmp_path.iterdir()) == []


def test_all_that_is_wrong_with_the_options_is_said_at_once(recorded, tmp_path):
    words = ("--n-components", "nan", "--landmarks", "nan", "--scheme", "autp", "-o", tmp_path / "lx.txt")
    code, _, complaint = opsim("motion", "fit", recorded / "a.npz", "missing.npz", *words)
    assert code == 2 and complaint.splitlines() == [
        f"{tmp_path / 'lx.txt'}: found the ending '.txt', but a library ends in .npz",
        "--n-components: found 'nan', expected a whole number from 1 or a share of variance such as 0.98",
        "scheme: no 'autp'; did you mean 'auto'?",
        "--landmarks: found 'nan', expected a number from 0 to 1",
        "missing.npz: no such file",
    ]


@pytest.mark.parametrize("words", [("--landmarks", "1.5"), ("--landmarks", "inf"), ("--scheme", "")])
def test_a_setting_out_of_range_is_refused(recorded, tmp_path, words):
    code, _, complaint = opsim("motion", "fit", recorded / "a.npz", "-o", tmp_path / "l.npz", *words)
    assert code == 2 and f"{words[0].removeprefix('--')}: " in complaint and f"{words[1]!r}" in complaint


WALKING = shipped_folder() / "libraries" / "walking.npz"


@pytest.fixture(scope="module")
def motion_fit_cyclic_recorded(tmp_path_factory):
    path = tmp_path_factory.mktemp("walks") / "stroll.npz"
    write_recording(make_walks(2, 3, seed=1)[0], path)
    return path


def test_walks_become_a_library_that_says_how_they_walk(motion_fit_cyclic_recorded, tmp_path):
    code, out, _ = opsim("motion", "fit", motion_fit_cyclic_recorded, "--cyclic", "-o", tmp_path / "lib.npz")
    assert code == 0
    assert "foot skate" in out and "stride time" in out
    model = MotionLibrary_of_motion_fit_cyclic.load(tmp_path / "lib.npz")["stroll"]
    assert model.report.command == "opsim motion fit stroll.npz -o lib.npz --cyclic"


def test_takes_are_chosen_by_where(motion_fit_cyclic_recorded, tmp_path):
    code, _, _ = opsim(
        "motion", "fit", motion_fit_cyclic_recorded, "--cyclic", "--where", "worker == w1", "-o", tmp_path / "one.npz"
    )
    assert code == 0
    assert MotionLibrary_of_motion_fit_cyclic.load(tmp_path / "one.npz")["stroll"].workers == ("w1",)


def test_settings_of_repetitions_are_refused_with_it(motion_fit_cyclic_recorded, tmp_path):
    code, _, err = opsim(
        "motion",
        "fit",
        motion_fit_cyclic_recorded,
        "--cyclic",
        "--landmarks",
        "0.1",
        "--where",
        "nobody == 1",
        "-o",
        tmp_path / "no.npz",
    )
    assert code == 2
    assert "--landmarks" in err and "nobody" in err
    assert not (tmp_path / "no.npz").exists()


def test_walks_are_shown_over_their_footprints(tmp_path):
    code, out, _ = opsim("motion", "show", WALKING, "walk", "-n", 1, "-o", tmp_path / "walk.svg")
    assert code == 0 and "made" in out
    svg = (tmp_path / "walk.svg").read_text()
    assert svg.count("<path") > 100


def test_walks_are_sampled_like_any_task(tmp_path):
    code, out, _ = opsim("motion", "sample", WALKING, "-n", 2, "-o", tmp_path / "walks.npz")
    assert code == 0 and "duration" in out
    assert (tmp_path / "walks.npz").exists()


ODD = 3  # emulated/k3


@pytest.fixture(scope="module")
def lifts(tmp_path_factory):
    """The arrays of eight made lifts, and the joints of each (T, J, 3)."""
    path = tmp_path_factory.mktemp("lifts") / "lift.npz"
    assert opsim("motion", "sample", "bench_work", "lift", "-n", 8, "--fps", 25, "-o", path)[0] == 0
    one_person(path)
    with np.load(path) as file:
        arrays = {key: file[key] for key in file.files if key not in ("duration",) and not key.startswith("ann_")}
    return arrays, np.split(arrays["positions"], arrays["offsets"][1:-1])


def of(lifts, parts, **changed):
    """The arrays of a file with these repetitions."""
    n = len(parts)
    whole = {"positions": np.concatenate(parts), "offsets": np.cumsum([0, *(len(part) for part in parts)])}
    labels = {key: lifts[0][key][:n] for key in ("subject", "trial")}
    return {**lifts[0], **whole, **labels, **changed}


def odd(lifts, change):
    """The file in which one repetition is changed."""
    return of(lifts, [change(part.copy()) if i == ODD else part for i, part in enumerate(lifts[1])])


def joint(lifts, name):
    return lifts[0]["names"].tolist().index(name)


def no_number(part):
    part[10, 3, 1] = np.nan
    return part


def still(part):
    return np.repeat(part[:1], len(part), axis=0)


def upside_down(part):
    return part * [1, 1, -1] + [0, 0, 2]


def teleported(part):
    part[10:14, 5] += [1.0, 0.0, 0.0]
    return part


def without_feet(lifts, *names):
    """The file without these joints."""
    for name in names:
        arrays = without(lifts, name)
        lifts = arrays, np.split(arrays["positions"], arrays["offsets"][1:-1])
    return lifts[0]


def without(lifts, name):
    """The file without one joint; what hung on it hangs on its parent."""
    gone, parents = joint(lifts, name), lifts[0]["parents"]
    keep = [i for i in range(len(parents)) if i != gone]
    onto = [parents[gone] if parents[i] == gone else parents[i] for i in keep]
    return of(
        lifts,
        [part[:, keep] for part in lifts[1]],
        names=lifts[0]["names"][keep],
        parents=np.array([keep.index(parent) if parent >= 0 else -1 for parent in onto]),
    )


def of_no_length(lifts, name, parent):
    def put(part):
        part[:, joint(lifts, name)] = part[:, joint(lifts, parent)]
        return part

    return odd(lifts, put)


def other_way(lifts, name, parent):
    """The arm below the parent points the other way throughout."""

    def put(part):
        part[:, joint(lifts, name)] = 2 * part[:, joint(lifts, parent)] - part[:, joint(lifts, name)]
        return part

    return odd(lifts, put)


REFUSED = {
    "one repetition": (lambda s: of(s, s[1][:1]), (), "bad.npz: found 1 repetition, expected 3 or more"),
    "two repetitions": (lambda s: of(s, s[1][:2]), (), "bad.npz: found 2 repetitions, expected 3 or more"),
    "two frames": (lambda s: odd(s, lambda p: p[:2]), (), "emulated/k3: found 2 frames, expected 4 or more"),
    "one frame": (lambda s: odd(s, lambda p: p[:1]), (), "offsets: found"),
    "a bone of no length": (
        lambda s: of_no_length(s, "left_wrist", "left_elbow"),
        (),
        "repetition emulated/k3: bone to joint 'left_wrist' has no length at frame 0",
    ),
    "a joint too few": (
        lambda s: of(s, s[1], positions=s[0]["positions"][:, :-1]),
        (),
        "20, 3), expected (frames, 21, 3) for 21 names",
    ),
    "a hip too few": (lambda s: without(s, "left_hip"), (), "left_hip"),
    "no number in all": (lambda s: of(s, [no_number(p.copy()) for p in s[1]]), (), "no repetition is left"),
    "more components than repetitions span": (
        lambda s: of(s, s[1]),
        ("--n-components", 8),
        "--n-components: found 8, expected at most 7 for 8 repetitions",
    ),
    "more components than copies span": (
        lambda s: of(s, [s[1][i // 2] for i in range(8)]),
        ("--n-components", 6),
        "bad: n_components: found 6, but the sequences span only 3",
    ),
}
NOTED = {
    "a joint that is elsewhere for a while": (
        lambda s: odd(s, teleported),
        "left out emulated/k3: a joint moves at 25.",
    ),
    "no feet": (
        lambda s: without_feet(s, "left_toe", "left_ankle", "right_toe", "right_ankle"),
        "no feet in the recordings",
    ),
    "one foot": (lambda s: without_feet(s, "left_toe", "left_ankle"), "no left foot in the recordings"),
    "one person": (lambda s: of(s, s[1]), "one person: how people differ is not known"),
    "no number in one": (
        lambda s: odd(s, no_number),
        "left out emulated/k3: positions are missing: neck at frame 10 (0.40 s)",
    ),
    "one stands still": (
        lambda s: odd(s, still),
        "1 of 8 repetitions do not move, their own clock is kept: emulated/k3",
    ),
    "all stand still": (lambda s: of(s, [still(p) for p in s[1]]), "8 of 8 repetitions do not move"),
    "one upside down": (
        lambda s: odd(s, upside_down),
        "far from every other repetition, another movement or a mistake:",
    ),
    "copies": (lambda s: odd(s, lambda _: s[1][4]), "copies of one recording, all used: emulated/k4 of emulated/k3"),
    "all one recording": (lambda s: of(s, [s[1][0]] * 8), "all repetitions are one and the same movement"),
    "a bone the other way": (
        lambda s: other_way(s, "left_shoulder", "chest"),
        "the bone to left_shoulder points opposite to the mean direction in emulated/k3 at",
    ),
    "no knee": (lambda s: without(s, "left_knee"), "bones breathe, most the one to left_ankle"),
}


QUICKLY_NOTED = ("one foot", "no number in one", "one stands still")
"""Cases that ``make test`` looks at; the others take long."""


def fit(folder, arrays, *words):
    np.savez(folder / "bad.npz", **arrays)
    return opsim("motion", "fit", folder / "bad.npz", "-o", folder / "lib.npz", "--n-times", 31, *words)


@pytest.mark.parametrize("case", REFUSED)
def test_what_cannot_be_fitted_is_refused_with_code_2_and_no_library(lifts, tmp_path, case):
    make, words, said = REFUSED[case]
    code, _, complaint = fit(tmp_path, make(lifts), *words)
    assert code == 2 and said in " ".join(complaint.split()), complaint
    assert not (tmp_path / "lib.npz").exists()


@pytest.mark.parametrize(
    "case", [case if case in QUICKLY_NOTED else pytest.param(case, marks=pytest.mark.slow) for case in NOTED]
)
def test_what_is_odd_is_fitted_with_a_note_on_the_screen_and_in_the_library(lifts, tmp_path, case):
    make, said = NOTED[case]
    code, shown, _ = fit(tmp_path, make(lifts))
    assert code == 0 and said.split(":")[0] in " ".join(shown.split())
    emulator = MotionEmulator_of_motion_bad_sets.load(tmp_path / "lib.npz")
    assert any(said in note for note in emulator.report.notes), emulator.report.notes
    assert np.all(np.isfinite(emulator.sample(20, np.random.default_rng(0)).positions_m(n_times=5)))


def test_a_bad_file_among_good_ones_is_named_before_any_fit(lifts, tmp_path):
    np.savez(tmp_path / "good.npz", **of(lifts, lifts[1]))
    np.savez(tmp_path / "one.npz", **of(lifts, lifts[1][:1]))
    np.savez(tmp_path / "short.npz", **of(lifts, lifts[1], positions=lifts[0]["positions"][:, :-1]))
    code, _, complaint = opsim(
        "motion", "fit", *(tmp_path / f"{name}.npz" for name in ("good", "one", "short")), "-o", tmp_path / "lib.npz"
    )
    said = " ".join(complaint.split())
    assert code == 2 and "one.npz: found 1 repetition" in said and "short.npz: positions: found" in said
    assert "aligning" not in complaint and not (tmp_path / "lib.npz").exists()


KINECT = {
    "pelvis": "hipcentre", "neck": "shouldercentre", "left_wrist": "wristleft", "left_toe": "FootLeft",
    "right_toe": "FootRight",
}  # fmt: skip


def renamed(lifts, names):
    arrays = of(lifts, lifts[1])
    return arrays | {"names": np.array([names.get(name, name) for name in arrays["names"].tolist()])}


def test_the_names_of_a_kinect_are_known_in_an_npz_too(lifts, tmp_path):
    code, shown, complaint = fit(tmp_path, renamed(lifts, KINECT))
    assert code == 0, complaint
    assert "joints: 21 kept" in " ".join(shown.split())
    assert MotionEmulator_of_motion_bad_sets.load(tmp_path / "lib.npz").skeleton.names == tuple(
        lifts[0]["names"].tolist()
    )


@pytest.mark.parametrize("words", [("fit",), ("import",), ("fit", "--cyclic")], ids=" ".join)
def test_names_that_are_not_known_are_given_by_a_mapping_file(lifts, tmp_path, monkeypatch, words):
    monkeypatch.setattr("opsim.report.motion.importing.draw_import", lambda *_: b"")
    np.savez(tmp_path / "bad.npz", **renamed(lifts, {"left_knee": "Gelenk 7"}))
    (tmp_path / "names.csv").write_text("Gelenk 7: left_knee\n")
    quick = QUICK if words == ("fit",) else words[1:]
    call = ("motion", words[0], tmp_path / "bad.npz", *quick, "-o", tmp_path / "out.npz")
    code, _, complaint = opsim(*call)
    assert code == 2
    assert "joint 'Gelenk 7' is not known" in " ".join(complaint.split())
    assert "name it with --map" in " ".join(complaint.split())
    code, _, complaint = opsim(*call, "--map", tmp_path / "names.csv")
    assert "Gelenk" not in complaint
    assert (code == 0) == (tmp_path / "out.npz").exists() == (len(words) == 1), complaint


def test_mistakes_of_a_mapping_file_are_told_with_their_line_and_a_missing_file_by_name(lifts, tmp_path):
    (tmp_path / "names.csv").write_text("left_nee: left_knee\n")
    code, _, complaint = fit(tmp_path, of(lifts, lifts[1]), "--map", tmp_path / "names.csv")
    assert code == 2
    assert "names.csv:1: no joint 'left_nee' in the recording; did you mean 'left_knee'?" in " ".join(complaint.split())
    code, _, complaint = fit(tmp_path, of(lifts, lifts[1]), "--map", tmp_path / "no.csv")
    assert code == 2
    assert "no.csv': no such file" in " ".join(complaint.split())


def test_a_joint_named_twice_is_told_with_both_places(lifts, tmp_path):
    code, _, complaint = fit(tmp_path, renamed(lifts, {"right_knee": "left_knee"}))
    assert code == 2
    assert "names: found 'left_knee' 2 times, as joint 14 and 18; give each" in " ".join(complaint.split())


def test_a_family_is_one_task_and_its_heights_are_shown(recorded, tmp_path):
    out = tmp_path / "lib.npz"
    code, shown, _ = opsim("motion", "fit", recorded / "a.npz", recorded / "b.npz", "--family", "ab", "-o", out, *QUICK)
    assert code == 0 and "ab: recordings by height at touch" in shown
    model = MotionLibrary.load(out)["ab"]
    assert model.report.n_sequences == 12 and model.report.command.endswith("--family 'ab'")


def test_each_band_of_heights_has_a_bar_and_the_number_of_recordings():
    low, high = (
        SimpleNamespace(places_m=np.array([[0.0, 0.0, h] for h in heights])) for heights in ([0.5, 0.55], [0.7])
    )
    rows = _rows([low, high])
    assert rows == [("0.7 to 0.8", "", "# 1"), ("0.6 to 0.7", "", ""), ("0.5 to 0.6", "## 2", "")]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--family", "ab"), "--family: found one file, expected two or more"),
        (("--family", "a/b"), "--family: found 'a/b', expected a name without '/'"),
        (("--family", "ab", "--task", "a"), "--task: found together with --family"),
        (("--family", "ab", "--cyclic"), "--cyclic: found together with --family"),
        (("--covariate", "amr"), "a.npz: no covariate 'amr'"),
        (("--cyclic", "--covariate", "arm"), "--covariate: found together with --cyclic"),
    ],
)
def test_what_cannot_be_a_family_or_explain_people_is_refused(recorded, tmp_path, words, said):
    code, _, complaint = opsim("motion", "fit", recorded / "a.npz", "-o", tmp_path / "l.npz", *words)
    assert code == 2 and said in complaint

"""``opsim motion sample``: draw performances from a library.

Drawn performances as BVH, a file each, for programs of animation and motion capture.
"""

from __future__ import annotations

import csv
import json
import math
import re
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import click

from opsim.cli.app import mistakes


class _Rate(click.FloatRange):
    """A range that nan is not in."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        rate = super().convert(value, param, ctx)
        if not math.isfinite(rate):
            self.fail(f"expected a number from {self.min:g} to {self.max:g}, found {value!r}", param, ctx)
        return rate


@click.command("sample")
@click.argument("library")
@click.argument("task", required=False)
@click.option("-n", "n", type=click.IntRange(min=1), default=10, show_default=True, help="Performances to draw.")
@click.option("--seed", type=click.IntRange(min=0), default=0, show_default=True)
@click.option(
    "-o",
    "--out",
    type=click.Path(path_type=Path),
    help="times as .csv; whole movements as .npz recordings, or as .bvh, a file each.",
)
@click.option(
    "--fps", type=_Rate(min=1, max=1000), default=50.0, show_default=True, help="Frames a second, for .npz and .bvh."
)
@click.option("--person", metavar="NAME", help="All by this person of the fit.  [default: each by another, new person]")
@click.option(
    "--new-people",
    type=click.IntRange(min=1),
    metavar="N",
    help="By so many new people, each several times.  [default: each by another]",
)
@click.option("--json", "as_json", is_flag=True, help="JSON for machines.")
def command(
    library: str,
    task: str | None,
    n: int,
    seed: int,
    out: Path | None,
    fps: float,
    person: str | None,
    new_people: int | None,
    as_json: bool,
) -> None:
    """Draw performances of a TASK of a LIBRARY: durations, marks and, into an .npz or .bvh file, the movements.

    Both may be said in one word, as in a scenario: public_movements/deep_squat.
    """
    import numpy as np

    from opsim.cli.app import print_json
    from opsim.cli.motion.files import chosen, library_and_task

    replaced: list[str] = []
    library, task = library_and_task(library, task)
    with mistakes():
        who = _who(n, person, new_people)
        model = chosen(library, task)
        _refuse(out, library)
        drawn = _drawn(model, who, person, np.random.default_rng(seed))
        if out is not None:
            said = f"opsim motion sample {Path(library).name} {model.task} -n {n} --seed {seed}"
            said += f" --person {person}" if person else f" --new-people {new_people}" if new_people else ""
            _write(out, model, drawn, fps, said, who)
            replaced = _without_other_draws(out, n)
    rows = [_row(model, drawn, k) for k in range(n)]
    if as_json:
        print_json({"task": model.task, "seed": seed, "out": None if out is None else str(out), "performances": rows})
        return
    _print_times(model, drawn)
    if out is not None:
        click.echo("\n".join([f"{n} performances: {_files(out, n)}", *replaced]))


def _who(n: int, person: str | None, new_people: int | None) -> list[str]:
    """Who does each of n performances, those of a person one after the other. Raises ValueError."""
    if person is not None and new_people is not None:
        raise ValueError("--person: found together with --new-people, expected one of them")
    if new_people is not None and new_people > n:
        raise ValueError(f"--new-people: found {new_people}, expected at most the {n} performances of -n")
    if person is not None:
        return [person] * n
    n_people = n if new_people is None else new_people
    return [f"new{k * n_people // n + 1}" for k in range(n)]


@dataclass(frozen=True)
class _ByPeople:
    """Performances of several people, those of each after those of the one before."""

    of: tuple[Any, ...]

    @property
    def skeleton(self) -> Any:
        return self.of[0].skeleton

    @property
    def duration_s(self) -> Any:
        import numpy as np

        return np.concatenate([own.duration_s for own in self.of])

    @property
    def mark_s(self) -> Any:
        import numpy as np

        return np.concatenate([own.mark_s for own in self.of])

    def __getitem__(self, k: int) -> Any:
        for own in self.of:
            if k < len(own.duration_s):
                return own[k]
            k -= len(own.duration_s)
        raise IndexError(k)


def _drawn(model: Any, who: list[str], person: str | None, rng: Any) -> Any:
    """The performances of ``who``; new people who have several are drawn one by one."""
    counts = Counter(who)
    if person is not None or len(counts) == len(who):
        return model.sample(len(who), rng, worker=person)
    return _ByPeople(tuple(model.sample(n, rng, worker=model.draw_worker(rng)) for n in counts.values()))


def _refuse(out: Path | None, library: str) -> None:
    """Raises ValueError where ``out`` cannot be written, or holds a library, such as the one that is read."""
    from opsim.cli.motion.files import found, of_another_kind, overwritten, ready

    if out is None:
        return
    if wrong := overwritten(out, library=[found(library)]) or of_another_kind(out, "recording"):
        raise ValueError("\n".join(wrong))
    ready(out, ".csv", ".npz", ".bvh")


def _without_other_draws(out: Path, n: int) -> list[str]:
    """Remove the .bvh files that an earlier draw of this name left, as an .npz is replaced; what was done, in words."""
    if out.suffix.lower() != ".bvh":
        return []

    ours, others = of_another_draw(out, n)
    for file in ours:
        file.unlink()
    said = [f"removed, of an earlier draw: {', '.join(file.name for file in ours)}"] if ours else []
    left = f"left beside them, not of this draw: {', '.join(file.name for file in others)}"
    return [*said, left] if others else said


def _files(out: Path, n: int) -> str:
    if out.suffix.lower() != ".bvh" or n == 1:
        return str(out)

    files = bvh_files(out, n)
    return f"{files[0]} to {files[-1].name}"


def _row(model: Any, drawn: Any, k: int) -> dict[str, float]:
    marks = {f"{name}_s": float(at) for name, at in zip(model.mark_names, drawn.mark_s[k])}
    return {"k": k, "duration_s": float(drawn.duration_s[k]), **marks}


def _print_times(model: Any, drawn: Any) -> None:
    import numpy as np

    from opsim.cli.app import print_table

    named = {"duration": drawn.duration_s, **dict(zip(model.mark_names, np.asarray(drawn.mark_s).T))}
    rows = [
        (name, *(f"{v:.3f} s" for v in (np.mean(times), *np.quantile(times, (0.05, 0.5, 0.95)))))
        for name, times in named.items()
    ]
    print_table(f"{model.task}: {len(drawn.duration_s)} performances", ("time", "mean", "5 %", "median", "95 %"), rows)


def _write(out: Path, model: Any, drawn: Any, fps: float, said: str, who: list[str]) -> None:
    if out.suffix.lower() == ".npz":
        _write_npz(out, model, drawn, fps, said, who)
        return
    if out.suffix.lower() == ".bvh":
        write_bvh_files(out, drawn, fps, _frame_times_s)
        return
    rows = [_row(model, drawn, k) for k in range(len(drawn.duration_s))]
    with out.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, fieldnames=list(rows[0]))
        writer.writeheader()
        writer.writerows(rows)


def _write_npz(out: Path, model: Any, drawn: Any, fps: float, said: str, who: list[str]) -> None:
    """The form of recordings, so that ``motion fit`` reads it again; the source says that it is emulated.

    who : the subject of each performance
    """
    import numpy as np

    frames = [
        drawn[k].positions_m(times_s=_frame_times_s(drawn.duration_s[k], fps))[0] for k in range(len(drawn.duration_s))
    ]
    report = model.report
    meta = {"source": f"emulated by {said}; fitted to {report.source}", "licence": report.licence}
    marks = {
        f"ann_{name}_frame": np.rint(drawn.mark_s[:, e] * fps).astype(int) for e, name in enumerate(model.mark_names)
    }
    np.savez_compressed(
        out,
        positions=np.concatenate(frames).astype(np.float32),
        offsets=np.cumsum([0, *(len(block) for block in frames)]),
        fps=fps,
        names=np.array(model.skeleton.names),
        parents=np.array(model.skeleton.parents),
        subject=np.array(who),
        trial=np.array([f"k{k}" for k in range(len(frames))]),
        duration=np.asarray(drawn.duration_s),
        meta=json.dumps(meta),
        **marks,  # type: ignore[arg-type]
    )


def _frame_times_s(duration_s: float, fps: float) -> Any:
    import numpy as np

    return np.arange(max(2, round(duration_s * fps) + 1)) / fps


def bvh_files(out: Path, n: int) -> list[Path]:
    """``out`` itself for one performance; else ``out`` with _k0, _k1, ... before its ending, as wide as the last."""
    if n == 1:
        return [out]
    digits = len(str(n - 1))
    return [out.with_stem(f"{out.stem}_k{k:0{digits}d}") for k in range(n)]


def write_bvh_files(out: Path, drawn: Any, fps: float, frame_times_s: Callable[[float, float], Any]) -> list[Path]:
    """Write each performance, and return the files.

    y points up, and our x stays X: what we import again is where it was and faces as it did. Who begins facing x faces
    X in the program of animation, not Z.
    """
    from emulator.recordings.bvh_write import write_bvh
    from emulator.recordings.take import Take

    files = bvh_files(out, len(drawn.duration_s))
    for k, file in enumerate(files):
        places = drawn[k].positions_m(times_s=frame_times_s(drawn.duration_s[k], fps))[0]
        write_bvh(Take(drawn.skeleton.names, drawn.skeleton.parents, places, fps, trial=f"k{k}"), file)
    return files


def of_another_draw(out: Path, n: int) -> tuple[list[Path], list[Path]]:
    """Files beside those of this draw that an earlier one to the same name left: (ours, those of other joints)."""
    new = {file.name for file in bvh_files(out, n)}
    name = re.compile(re.escape(out.stem) + r"(_k[0-9]+)?" + re.escape(out.suffix))
    there = [file for file in sorted(out.parent.iterdir()) if name.fullmatch(file.name) and file.name not in new]
    there = [file for file in there if file.is_file() and not file.is_symlink()]
    ours = [file for file in there if _is_ours(file)]
    return ours, [file for file in there if file not in ours]


def _is_ours(file: Path) -> bool:
    """Whether its joints are called as those that we write."""
    from emulator.skeleton import CANONICAL, EXTRA

    with file.open("rb") as stream:
        head = stream.read(1 << 16)
    names = re.findall(rb"^\s*(?:ROOT|JOINT) (\S+)\s*$", head, re.MULTILINE)
    return bool(names) and {name.decode("latin-1") for name in names} <= {*CANONICAL, *EXTRA}

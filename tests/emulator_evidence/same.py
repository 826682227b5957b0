"""``python -m emulator_evidence.same CHECKOUT``: the emulator here gives what that of another checkout gives.

Fits of made tasks, draws and bodies of all kinds, the bytes of libraries, tables of the paper: to 1e-12.
"""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

HERE = Path(__file__).parents[2]
CLOSE = 1e-12


def main(other: Path) -> int:
    """0 where everything is the same."""
    with TemporaryDirectory() as folder:
        ours, theirs = (_figures(root, Path(folder) / f"{k}.npz") for k, root in enumerate((HERE, other)))
    wrong = differences(ours, theirs)
    print(f"{len(ours)} arrays, {sum(a.size for a in ours.values()):,} numbers; {len(wrong)} differ")
    print("\n".join(wrong))
    return int(bool(wrong))


def differences(ours: dict[str, np.ndarray], theirs: dict[str, np.ndarray]) -> list[str]:
    """A line for each array that is elsewhere or not the same to ``CLOSE``."""
    lines = [f"{name}: only in one of the two" for name in sorted(set(ours) ^ set(theirs))]
    for name in sorted(set(ours) & set(theirs)):
        one, two = ours[name], theirs[name]
        if one.shape != two.shape:
            lines.append(f"{name}: {one.shape} and {two.shape}")
        elif not np.allclose(one.astype(float), two.astype(float), rtol=CLOSE, atol=CLOSE, equal_nan=True):
            lines.append(f"{name}: up to {np.nanmax(np.abs(one.astype(float) - two.astype(float))):.3g} apart")
    return lines


def _figures(root: Path, out: Path) -> dict[str, np.ndarray]:
    """What the emulator of this checkout gives, in a process of its own; libraries are ours."""
    script, libraries = Path(__file__).with_name("figures.py"), HERE / "scenarios/libraries"
    environment = os.environ | {"PYTHONPATH": str(root)}
    subprocess.run([sys.executable, str(script), str(out), str(libraries)], env=environment, cwd=root, check=True)
    with np.load(out) as held:
        return dict(held)


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]).resolve()))

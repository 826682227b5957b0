"""The library of handling: one made movement to shelves at heights from 0.1 to 1.9 m, by people of 1.5 to 2.0 m.

``python -m emulator.synthetic.handling -o handling.npz`` fits the library that scenarios with heights use.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from emulator.synthetic.shelf import crew, make_shelf
from emulator.synthetic.tasks import SOURCE

if TYPE_CHECKING:
    from emulator.model.library import MotionLibrary


def handling_library(
    seed: int = 0, n_workers: int = 12, n_repetitions: int = 16, command: str = "python -m emulator.synthetic.handling"
) -> MotionLibrary:
    """A library of the one task ``shelf``, fitted to ``n_workers`` times ``n_repetitions`` made repetitions."""
    from emulator.model.emulator import MotionEmulator
    from emulator.model.library import MotionLibrary

    people = crew(n_workers, np.random.default_rng([seed, 0]))
    motions = make_shelf(people, n_repetitions, rng=np.random.default_rng([seed, 1]))
    fitted = MotionEmulator.fit(motions, command=command, seed=seed)
    return MotionLibrary.of(fitted, command=command, notes=(SOURCE,))


def main(arguments: Sequence[str] | None = None) -> None:
    """Write the library of handling and say what was fitted."""
    parser = argparse.ArgumentParser(prog="python -m emulator.synthetic.handling", description=main.__doc__)
    parser.add_argument("-o", "--output", type=Path, required=True, help="the library to write (.npz)")
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args(arguments)
    command = f"python -m emulator.synthetic.handling -o {options.output.name} --seed {options.seed}"
    library = handling_library(options.seed, command=command)
    library.save(options.output)
    print("; ".join(f"{label}: {text}" for label, text in library.only().report.rows()))
    print(f"{options.output}: {options.output.stat().st_size / 1000:.0f} kB")


if __name__ == "__main__":
    main()

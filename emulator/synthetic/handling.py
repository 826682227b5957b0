"""The library of handling: one made movement to shelves at heights from 0.1 to 1.9 m, by people of 1.5 to 2.0 m.

``python -m emulator.synthetic.handling -o handling.npz`` fits the library that scenarios with heights use.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from emulator.synthetic.shelf import crew, make_shelf
from emulator.synthetic.tasks import SOURCE, write_library

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
    write_library("python -m emulator.synthetic.handling", main.__doc__, handling_library, arguments)


if __name__ == "__main__":
    main()

"""``opsim motion``: train a motion emulator, draw from it, look at it."""

import click

from opsim.cli.app import Verbs


@click.group(
    "motion",
    cls=Verbs,
    verbs={
        "import": "opsim.cli.motion.import_files",
        "clean": "opsim.cli.motion.clean",
        "segment": "opsim.cli.motion.segment",
        "fit": "opsim.cli.motion.fit",
        "sample": "opsim.cli.motion.sample",
        "show": "opsim.cli.motion.show",
        "score": "opsim.cli.motion.score",
        "judge": "opsim.cli.motion.judge",
        "people": "opsim.cli.motion.people",
    },
)
def command() -> None:
    """Train motion emulators on recordings, draw performances, look at them, judge them, tell people apart."""

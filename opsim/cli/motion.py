"""``opsim motion``: train a motion emulator, draw from it, look at it."""

import click

from opsim.cli.verbs import Verbs


@click.group(
    "motion",
    cls=Verbs,
    verbs={
        "import": "opsim.cli.motion_import",
        "clean": "opsim.cli.motion_clean",
        "segment": "opsim.cli.motion_segment",
        "fit": "opsim.cli.motion_fit",
        "sample": "opsim.cli.motion_sample",
        "show": "opsim.cli.motion_show",
        "score": "opsim.cli.motion_score",
        "judge": "opsim.cli.motion_judge",
        "people": "opsim.cli.motion_people",
    },
)
def command() -> None:
    """Train motion emulators on recordings, draw performances, look at them, judge them, tell people apart."""

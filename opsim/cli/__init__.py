"""The command line: one file a verb, loaded when it is called, so that ``opsim --help`` costs next to nothing."""

import click

from opsim import __version__
from opsim.cli.app import Verbs


@click.group(
    cls=Verbs,
    verbs={
        "init": "opsim.cli.init",
        "check": "opsim.cli.check",
        "run": "opsim.cli.run",
        "report": "opsim.cli.report",
        "view": "opsim.cli.view",
        "compare": "opsim.cli.compare",
        "sweep": "opsim.cli.sweep",
        "select": "opsim.cli.select",
        "labour": "opsim.cli.labour",
        "layout": "opsim.cli.layout",
        "merge": "opsim.cli.merge",
        "warm-up": "opsim.cli.warm_up",
        "long-run": "opsim.cli.long_run",
        "export": "opsim.cli.export",
        "sql": "opsim.cli.sql",
        "fit": "opsim.cli.fit",
        "motion": "opsim.cli.motion",
        "schema": "opsim.cli.schema",
        "effects": "opsim.cli.effects",
        "doctor": "opsim.cli.doctor",
    },
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 110},
)
@click.version_option(__version__, message="opsim %(version)s")
def main() -> None:
    """Simulate production whose work is done by people.

    A scenario is a YAML file, or the name of a shipped one, such as repack_cell; `opsim init --list` names them all.
    """

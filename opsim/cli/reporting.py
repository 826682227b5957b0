"""Writing the reports of a run: one file a variant, and a word on whatever could not be made."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import click


def write_reports(
    runs: Mapping[str, Any],
    results: Mapping[str, Any],
    paths: Mapping[str, Path],
    svg: Mapping[str, Path] | None = None,
) -> dict[str, list[Path]]:
    """Write the report of each run to its path; returns the SVG files of each, where folders for them are given.

    results : of all variants, which stand beside each other in every report. Raises OSError, and ValueError where
    figures are wanted as SVG and matplotlib is not there.
    """
    from opsim.report import materials, write_report

    drawn: dict[str, list[Path]] = {}
    for name, material in materials(runs, results):
        written = write_report(material, paths[name])
        for reason, which in written.contents.missing:
            click.echo(f"warning: {name}: the report lacks {which}, which could not be made: {reason}", err=True)
        if svg is not None:
            from opsim.report.figure_files import write_figures

            drawn[name] = write_figures(written.contents, svg[name])
    return drawn

"""A result as one HTML file that needs nothing else: no network, no other file, no script but its own two."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from opsim.report.contents import Contents, contents_of
from opsim.report.material import Material
from opsim.report.offline import asset, policy, template
from opsim.report.sentence import sentences
from opsim.report.words import clock
from opsim.whole import write_text

BUNDLE = "assets/plotly-cartesian.min.js"


@dataclass(frozen=True)
class Written:
    """A report that was written, and what is in it."""

    path: Path
    contents: Contents


def write_report(material: Material, path: str | Path) -> Written:
    """Write the report of one scenario variant. Raises OSError where it cannot be written."""
    path, contents = Path(path), contents_of(material)
    write_text(path, report_html(material, contents))
    return Written(path, contents)


def report_html(material: Material, contents: Contents | None = None) -> str:
    """The page as text. Names are escaped: in HTML by jinja2, in JSON by ``tojson``, in figures by ``escape``."""
    summary, contents = material.summary, contents or contents_of(material)
    bundle, script = asset(BUNDLE), asset("zoom.js") + asset("report.js")
    return template("report.html.jinja").render(
        summary=summary,
        window=[clock(summary["start"], at_s) for at_s in summary["window_s"]],
        sentences=sentences(summary),
        contents=contents,
        figures={name: figure for section in contents.sections for name, figure in section.charts.items()},
        bundle=bundle,
        script=script,
        style=asset("report.css"),
        policy=policy(bundle, script),
    )

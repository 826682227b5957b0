"""From raw recordings to tasks, shown: ``make take-evidence``. Claims with what was found, and their pictures."""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Iterable, Iterator
from html import escape
from importlib import import_module
from pathlib import Path
from typing import NamedTuple

PARTS = (
    "readers",
    "readers_bvh",
    "cleaning",
    "segmenting",
    "cyclic",
    "walking",
    "composite",
    "scenario_walking",
)
"""Modules of this package, each with ``evidence(motion, out)`` that yields (claim, found, holds)."""
PICTURES = (".svg", ".png")


class Line(NamedTuple):
    """One claim of a part, what was found, and whether its bound holds."""

    part: str
    claim: str
    found: str
    holds: bool


def main(arguments: list[str] | None = None) -> int:
    """0 where every bound holds, 1 where one does not, 2 where the recordings are not at hand."""
    from tests.recordings import data_folder

    options = _options(arguments)
    motion = data_folder() / "motion"
    if not motion.is_dir():
        print("needs motion/ in ../shared/data or in $OPSIM_DATA", file=sys.stderr)
        return 2
    found = []
    for line in lines(options.parts, motion, options.out):
        print(f"{'holds' if line.holds else 'FAILS'}  {line.part}: {line.claim}: {line.found}", flush=True)
        found.append(line)
    page = options.out / "evidence.html"
    page.write_text(as_page(found, options.out), encoding="utf-8")
    failed = [line for line in found if not line.holds]
    print(f"\n{len(found) - len(failed)} of {len(found)} bounds hold; pictures: {page}")
    return int(bool(failed))


def lines(parts: Iterable[str], motion: Path, out: Path) -> Iterator[Line]:
    """The lines of each part; its pictures go into a folder of its name below ``out``."""
    for part in parts:
        folder = out / part
        folder.mkdir(parents=True, exist_ok=True)
        start_s = time.monotonic()
        for claim, found, holds in import_module(f"take_evidence.{part}").evidence(motion, folder):
            yield Line(part, claim, found, bool(holds))
        print(f"{part}: {time.monotonic() - start_s:.0f} s", file=sys.stderr)


def as_page(found: list[Line], out: Path) -> str:
    """One offline page: each part's lines in a table, and its pictures below."""
    body = []
    for part in dict.fromkeys(line.part for line in found):
        rows = "".join(
            f"<tr class='{'holds' if line.holds else 'fails'}'><td>{escape(line.claim)}<td>{escape(line.found)}"
            for line in found
            if line.part == part
        )
        shown = sorted(path for path in (out / part).rglob("*") if path.suffix in PICTURES)
        pictures = "".join(_figure(path.relative_to(out).as_posix(), path.name) for path in shown)
        body.append(f"<h2>{escape(part)}</h2><table>{rows}</table>{pictures}")
    style = (
        "body{font:15px/1.5 system-ui;max-width:72rem;margin:2rem auto;padding:0 1rem}td{padding:.2rem .8rem;"
        "vertical-align:top;border-top:1px solid #ddd}.fails{background:#fde8e4}img{max-width:100%}"
    )
    return f"<!doctype html><meta charset='utf-8'><title>take evidence</title><style>{style}</style>{''.join(body)}"


def _figure(source: str, caption: str) -> str:
    return f"<figure><img src='{escape(source)}'><figcaption>{escape(caption)}</figcaption></figure>"


def _options(arguments: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m take_evidence.show", description=__doc__)
    parser.add_argument("parts", nargs="*", metavar="PART", help=", ".join(PARTS))
    parser.add_argument("-o", "--out", type=Path, default=Path("take_evidence"), help="folder for the pictures")
    options = parser.parse_args(arguments)
    unknown = [part for part in options.parts if part not in PARTS]
    if unknown:
        parser.error(f"no part {unknown[0]!r}; known: {', '.join(PARTS)}")
    options.parts = options.parts or list(PARTS)
    return options


if __name__ == "__main__":
    sys.exit(main())

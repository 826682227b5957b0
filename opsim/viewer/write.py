"""The replay as one HTML file: the page, what is known in JSON, and the columns of each variant as base64 of gzip."""

from __future__ import annotations

import base64
import gzip
from collections.abc import Iterator, Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any

from opsim import __version__
from opsim.report.offline import policy
from opsim.whole import whole_file

FORMAT = 1
SPEEDS = (0.5, 1, 2, 5, 10, 20, 50, 100, 200)
HERE = Path(__file__).parent
AT_ONCE = 3 * 2**18
"""Bytes that become base64 at a time: a multiple of three, so that the pieces join without padding."""
LEVEL = 6
"""Of gzip: 9 takes three times as long and saves 1 %."""
_HERE = "<!-- the columns stand here -->"


def write_replay(
    parts: Sequence[tuple[dict[str, Any], bytes]], path: str | Path, title: str, notes: Sequence[tuple[str, str]] = ()
) -> int:
    """Write the page and return how many bytes it has; the same parts give the same bytes.

    parts : of each variant what is known of it, with the table of its columns, and the raw bytes of these
    notes : (topic, words): what is shown and what is not known
    Raises ValueError for no variant at all.
    """
    if not parts:
        raise ValueError("a replay needs a variant at least; found none")
    variants = [variant for variant, _ in parts]
    before, after = _page(variants, title, _notes(variants, notes)).split(_HERE)
    written = 0
    with whole_file(Path(path)) as temporary, open(temporary, "wb") as out:
        written += out.write(before.encode())
        for number, (_, columns) in enumerate(parts):
            written += sum(out.write(piece) for piece in _block(number, columns))
        written += out.write(after.encode())
    return written


@lru_cache(maxsize=1)
def page_script() -> str:
    """The one script of pages with moving people, built from ``page/``; three.js is inside it."""
    return (HERE / "assets" / "replay.min.js").read_text(encoding="utf-8")


def _notes(variants: Sequence[dict[str, Any]], notes: Sequence[tuple[str, str]]) -> list[tuple[str, str]]:
    """The notes of the page and those of its variants, each once."""
    own = [(topic, words) for variant in variants for topic, words in variant.get("notes", ())]
    return list(dict.fromkeys([*((topic, words) for topic, words in notes), *own]))


def _page(variants: list[dict[str, Any]], title: str, notes: Sequence[tuple[str, str]]) -> str:
    """The page without its columns. Names are escaped by jinja2, and in JSON by ``tojson``."""
    from jinja2 import Environment, FileSystemLoader, StrictUndefined
    from markupsafe import Markup

    environment = Environment(
        loader=FileSystemLoader(HERE), autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    meta = {"format": FORMAT, "opsim": __version__, "title": title, "notes": list(notes), "variants": variants}
    return environment.get_template("replay.html.jinja").render(
        title=title,
        notes=notes,
        meta=meta,
        speeds=SPEEDS,
        style=(HERE / "replay.css").read_text(encoding="utf-8"),
        script=page_script(),
        policy=policy(page_script()),
        columns_here=Markup(_HERE),
    )


def _block(number: int, columns: bytes) -> Iterator[bytes]:
    """The script element of one variant's columns, in pieces; nothing in it is run."""
    packed = gzip.compress(columns, LEVEL, mtime=0)
    yield f'<script type="text/plain" id="columns-{number}">'.encode()
    for start in range(0, len(packed), AT_ONCE):
        yield base64.b64encode(packed[start : start + AT_ONCE])
    yield b"</script>\n"

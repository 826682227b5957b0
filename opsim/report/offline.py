"""What every page of ours shares: one file that fetches nothing, and scripts that run only as they were written."""

from __future__ import annotations

import base64
import hashlib
from functools import lru_cache
from pathlib import Path
from typing import Any

HERE = Path(__file__).parent


@lru_cache(maxsize=16)
def asset(name: str) -> str:
    """The text of a style sheet or script that lies beside this file."""
    return (HERE / name).read_text(encoding="utf-8")


@lru_cache(maxsize=4)
def template(name: str) -> Any:
    """A jinja2 template that lies beside this file: names are escaped, a name that is not given is an error."""
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    environment = Environment(
        loader=FileSystemLoader(HERE),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    return environment.get_template(name)


def policy(*scripts: str) -> str:
    """The browser runs the scripts with these hashes and fetches nothing, whatever a name may have smuggled in."""
    hashes = [base64.b64encode(hashlib.sha256(script.encode()).digest()).decode() for script in scripts]
    allowed = " ".join(f"'sha256-{digest}'" for digest in hashes)
    fetched = f"default-src 'none'; script-src {allowed}; style-src 'unsafe-inline'; img-src data:"
    return f"{fetched}; base-uri 'none'; form-action 'none'"

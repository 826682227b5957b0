"""``opsim init``: a short scenario to put own numbers into, or a shipped one, and the schema by which editors help."""

from __future__ import annotations

import re
from itertools import dropwhile, takewhile
from pathlib import Path

import click

from opsim.cli.app import Mistake, mistakes

DEFAULT = "starter"
SHORT = 200


@click.command("init")
@click.argument("template", required=False)
@click.option("-o", "--out", type=click.Path(path_type=Path), help="File to write.  [default: the template's name]")
@click.option("--list", "only_list", is_flag=True, help="Show the templates, write nothing.")
@click.option("--json", "as_json", is_flag=True, help="JSON for machines.")
def command(template: str | None, out: Path | None, only_list: bool, as_json: bool) -> None:
    """Begin a scenario: a short commented one to put your own numbers into, which runs as it stands.

    TEMPLATE: instead one of the shipped scenarios, such as repack_cell; --list shows them.
    """
    from opsim.cli.app import print_json, print_table

    templates = _templates()
    if only_list:
        rows = [(name, _first_words(text)) for name, text in templates.items()]
        if as_json:
            print_json({"templates": dict(rows)})
        else:
            print_table("templates", ("name", "what it is"), rows, words=2)
        return
    name = _known(DEFAULT if template is None else template.removesuffix(".yaml"), templates)
    out = Path(f"{name}.yaml") if out is None else out
    with mistakes(OSError):
        schema = _write(out, templates[name])
    if as_json:
        print_json({"scenario": str(out), "template": name, "schema": str(schema)})
        return
    click.echo(f"scenario {out}, from {name}")
    click.echo(f"schema {schema}, for editors")
    click.echo(f"next: opsim check {out}")


def _templates() -> dict[str, str]:
    from opsim.shipped import shipped_folder, shipped_scenarios

    return {name: (shipped_folder() / f"{name}.yaml").read_text(encoding="utf-8") for name in shipped_scenarios()}


def _known(name: str, templates: dict[str, str]) -> str:
    from opsim.problems import did_you_mean, shown

    if name not in templates:
        raise Mistake(f"no template {shown(name)}; {did_you_mean(name, templates, otherwise='templates')}")
    return name


def _write(out: Path, text: str) -> Path:
    """The scenario with its schema beside it; a file that is there is never written over."""
    from opsim.files import write_text
    from opsim.scenario.json_schema import FILE_NAME, schema_text

    if out.exists():
        raise Mistake(f"{out} is there already; name another file with -o, or remove it")
    schema = out.parent / FILE_NAME
    if not schema.exists():
        write_text(schema, schema_text())
    lines = [line for line in text.splitlines() if not line.startswith("# yaml-language-server:")]
    write_text(out, "\n".join([f"# yaml-language-server: $schema=./{FILE_NAME}", *lines]) + "\n")
    return schema


def _first_words(text: str) -> str:
    """What a template says of itself: of its first comment the first sentence, and those that fit beside it."""
    sentences = re.split(r"(?<=[.?!])(?:\n|\s+(?=[A-Z]))", _first_comment(text))
    said = sentences[0]
    for sentence in sentences[1:]:
        if len(said) + len(sentence) >= SHORT:
            break
        said += f" {sentence}"
    return " ".join(said.split())


def _first_comment(text: str) -> str:
    """The first lines of comment that follow each other, but for the one that is there for editors."""
    lines = [line for line in text.splitlines() if not line.startswith("# yaml-language-server")]
    begun = dropwhile(lambda line: not line.startswith("# "), lines)
    return "\n".join(line.removeprefix("# ") for line in takewhile(lambda line: line.startswith("# "), begun))

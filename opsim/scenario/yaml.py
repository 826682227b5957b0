"""What the YAML parser says, in plain words.

The bytes of a file -> its text, bounded in size; what is no text is refused with the place of the bad byte.

YAML text -> a tree of nodes with their places.

The C parser of PyYAML gives events; the tree is built here, so that depth, size and aliases of a hostile file are
bounded, duplicate keys are found, and plain scalars follow the YAML 1.2 core schema (``no`` is text, ``10:30`` is text,
``010`` is ten).
"""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import yaml

from opsim.problems import MOST_FOUND, Problem, ScenarioError, did_you_mean, shown
from opsim.scenario.tree import Node, Part, Place, Source, problem

NOT_PRINTABLE = re.compile("[^\t\n\r\x20-\x7e\x85\xa0-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")

# (words of the parser, what it means, the way out)
_INDENT = "give it the indent of its neighbours"
_MEANINGS = (
    (
        "mapping values are not allowed",
        "a second ': ' in one value",
        "put the value in quotes, or the key on its own line",
    ),
    ("did not find expected key", "this line does not fit the block around it", _INDENT),
    ("did not find expected ',' or ']'", "the list begun with '[' does not end", "is a ',' or ']' missing?"),
    ("did not find expected ',' or '}'", "the block begun with '{' does not end", "is a ',' or '}' missing?"),
    ("could not find expected ':'", "a key without ':'", "write 'key: value', with a space after the ':'"),
    ("block sequence entries are not allowed", "a list item '- ' cannot stand here", "put it on a line of its own"),
    ("found unexpected end of stream", "a quote is opened and never closed", "close it on the same line"),
    ("did not find expected '-' indicator", "this line does not fit the list around it", _INDENT),
    ("did not find expected node content", "a value is missing here", ""),
    ("found unknown escape character", "an unknown escape after '\\'", "in double quotes write '\\\\' for a backslash"),
    ("did not find expected <document start>", "this line does not fit what stands above", "is a key missing above?"),
)


def syntax_problem(error: yaml.MarkedYAMLError, source: Source) -> Problem:
    """The problem behind a syntax error of the parser; a quote that never ends is said where it begins."""
    mark, begun = error.problem_mark or error.context_mark, error.context_mark
    words = error.problem or error.context or "it cannot be read"
    if begun is not None and "unexpected end of stream" in words:
        mark = begun
    place = Place(source, 0, 0) if mark is None else Place(source, mark.line, mark.column)
    message, hint = _meaning(words, place)
    if begun is not None and begun.line != place.line and "begun" in message:
        message += f" (it begins on line {begun.line + 1})"
    return problem(place, "", f"not YAML: {message}", hint)


def _meaning(words: str, place: Place) -> tuple[str, str]:
    if "cannot start any token" in words:
        return _bad_start(place)
    for said, message, hint in _MEANINGS:
        if said in words:
            return message, hint
    return words, ""


def _bad_start(place: Place) -> tuple[str, str]:
    lines = place.source.lines
    line = lines[place.line] if place.line < len(lines) else ""
    character = line[place.column : place.column + 1]
    if character == "\t":
        return "a tab stands where the indent is", "indent with spaces"
    return f"a value cannot begin with {shown(character)}", "put it in quotes"


MOST_BYTES = 8_000_000
MOST_LINES = 100_000


def read_bytes(file: Path) -> bytes:
    """What stands in a file, as far as a scenario may be long. Raises ScenarioError where it cannot be read."""
    try:
        with file.open("rb") as opened:
            return opened.read(MOST_BYTES + 1)
    except OSError as error:
        raise ScenarioError([Problem(str(file), 0, 0, "", f"cannot be read: {error.strerror}")]) from None


def decoded(raw: bytes, file: str) -> str:
    """The file as text: UTF-8, or UTF-16 with its mark; anything else is refused with the place of the bad byte."""
    if len(raw) > MOST_BYTES:
        big = f"the file is larger than {MOST_BYTES / 1e6:.0f} MB, the most a scenario may have"
        raise ScenarioError([Problem(file, 0, 0, "", big)])
    utf16 = raw[:2] in (b"\xff\xfe", b"\xfe\xff")
    try:
        text = raw.decode("utf-16" if utf16 else "utf-8-sig")
    except UnicodeDecodeError as error:
        if b"\0" in raw:
            raise ScenarioError([_binary(file)]) from None
        before = raw[: error.start].decode("utf-8-sig", "replace")
        place = _place_at(before + "\N{REPLACEMENT CHARACTER}", len(before), file)
        found = f"byte 0x{raw[error.start]:02x} is not UTF-8 text"
        raise ScenarioError([problem(place, "", found, "save the file as UTF-8")]) from None
    n_lines = text.count("\n")
    if n_lines > MOST_LINES:
        raise ScenarioError(
            [Problem(file, 0, 0, "", f"the file has {n_lines:,} lines; at most {MOST_LINES:,} are read")]
        )
    bad = NOT_PRINTABLE.search(text)
    if bad is not None and bad[0] == "\0":
        raise ScenarioError([_binary(file)])
    if bad is not None:
        found = f"a control character (U+{ord(bad[0]):04X}) stands here"
        raise ScenarioError([problem(_place_at(text, bad.start(), file), "", found, "remove it")])
    return text


def _binary(file: str) -> Problem:
    return Problem(file, 0, 0, "", "this is a binary file, not a scenario", "a scenario is a YAML text file")


def _place_at(text: str, index: int, file: str) -> Place:
    before = text[:index]
    line = len((before + "x").splitlines()) - 1
    last = (before + "x").splitlines()[-1]
    return Place(Source(file, tuple(text.splitlines())), line, len(last) - 1)


DEEPEST = 30
MOST_NODES = 200_000

_Parser: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
_INTEGER = re.compile(r"[-+]?[0-9]+|0o[0-7]+|0x[0-9a-fA-F]+")
_FLOAT = re.compile(r"[-+]?(?:\.[0-9]+|[0-9]+(?:\.[0-9]*)?)(?:[eE][-+]?[0-9]+)?")
STEERING = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u2028\u2029\u202a-\u202e\u2066-\u2069\ufeff]")
"""Characters that move a cursor, change colours, or turn the direction of a line about; a tab or a new line is none."""
_WORDS = {
    **dict.fromkeys(("", "~", "null", "Null", "NULL"), None),
    **dict.fromkeys(("true", "True", "TRUE"), True),
    **dict.fromkeys(("false", "False", "FALSE"), False),
    **dict.fromkeys((".inf", ".Inf", ".INF", "+.inf", "+.Inf", "+.INF"), float("inf")),
    **dict.fromkeys(("-.inf", "-.Inf", "-.INF"), float("-inf")),
    **dict.fromkeys((".nan", ".NaN", ".NAN"), float("nan")),
}


def scalar(text: str) -> Any:
    """The value of a plain scalar in the YAML 1.2 core schema."""
    if text in _WORDS:
        return _WORDS[text]
    if len(text) > 300:  # no number that can be meant, and int() would be slow or refuse
        return text
    if _INTEGER.fullmatch(text):
        return int(text, {"0o": 8, "0x": 16}.get(text[:2], 10))
    return float(text) if _FLOAT.fullmatch(text) else text


@dataclass
class Budget:
    """How many values have been read, over all files of a scenario; aliases count as what they stand for."""

    n_nodes: int = 0


def read_tree(raw: bytes, file: str, budget: Budget | None = None) -> tuple[Node, list[Problem]]:
    """The tree of a file and what is wrong with its keys. Raises ScenarioError where no tree can be had at all."""
    text = decoded(raw, file)
    source = Source(file, tuple(text.splitlines()))
    parser = _Parser(text)
    try:
        return _Builder(source, parser, Budget() if budget is None else budget).document()
    except yaml.MarkedYAMLError as error:
        raise ScenarioError([syntax_problem(error, source)]) from None
    except yaml.YAMLError:
        raise ScenarioError([Problem(file, 0, 0, "", "this is not YAML")]) from None
    finally:
        parser.dispose()


class _Builder:
    """Builds the tree from the events of one file."""

    def __init__(self, source: Source, parser: Any, budget: Budget):
        self.source, self.parser, self.budget = source, parser, budget
        self.problems: list[Problem] = []
        self.anchors: dict[str, tuple[Node, int]] = {}

    def document(self) -> tuple[Node, list[Problem]]:
        self.parser.get_event()
        if self.parser.check_event(yaml.StreamEndEvent):
            hint = "a scenario begins with 'opsim: 1'"
            raise ScenarioError([Problem(self.source.file, 0, 0, "", "the file is empty", hint)])
        self.parser.get_event()
        root = self.node((), None)
        self.parser.get_event()
        if not self.parser.check_event(yaml.StreamEndEvent):
            place = self.place(self.parser.get_event())
            raise self.stop(place, (), "a second document begins here", "a file holds one scenario; remove the '---'")
        return root, self.problems

    def node(self, path: tuple[Part, ...], key: Place | None) -> Node:
        """The next value, with everything inside it."""
        event = self.parser.get_event()
        place = self.place(event)
        if isinstance(event, yaml.AliasEvent):
            return self.alias(event.anchor, place, path, key)
        before = self.budget.n_nodes
        self.count(1, place, path)
        value: Any
        if isinstance(event, yaml.ScalarEvent):
            text = self.clean(event.value, place)
            value = scalar(text) if event.implicit[0] and not event.style else text
        elif len(path) >= DEEPEST:
            raise self.stop(place, path[:3], f"blocks inside blocks, more than {DEEPEST} deep", "")
        elif isinstance(event, yaml.SequenceStartEvent):
            value = self.list_items(path)
        else:
            value = self.entries(path)
        if event.tag not in (None, "!"):
            self.problems.append(problem(place, path, f"the tag {shown(event.tag)} means nothing here", "remove it"))
        node = Node(value, place, key)
        if event.anchor is not None:
            self.anchors[event.anchor] = (node, self.budget.n_nodes - before)
        return node

    def list_items(self, path: tuple[Part, ...]) -> list[Node]:
        found: list[Node] = []
        while not self.parser.check_event(yaml.SequenceEndEvent):
            found.append(self.node((*path, len(found)), None))
        self.parser.get_event()
        return found

    def entries(self, path: tuple[Part, ...]) -> dict[str, Node]:
        found: dict[str, Node] = {}
        while not self.parser.check_event(yaml.MappingEndEvent):
            if len(self.problems) >= MOST_FOUND:
                raise ScenarioError(self.problems)
            key, place = self.key(path)
            node = self.node((*path, key), place)
            if key in found:
                first = found[key].name_place.line + 1
                self.problems.append(
                    problem(place, (*path, key), "this key stands twice", f"the first is on line {first}")
                )
            elif key == "<<":
                self.problems.append(
                    problem(place, (*path, key), "merge keys are not read", "write 'like: NAME' instead")
                )
            else:
                found[key] = node
        self.parser.get_event()
        return found

    def key(self, path: tuple[Part, ...]) -> tuple[str, Place]:
        """A key is the text that stands there: ``no``, ``1`` and ``010`` are the names they look like."""
        event = self.parser.get_event()
        place = self.place(event)
        if not isinstance(event, yaml.ScalarEvent):
            raise self.stop(place, path, "a key must be a word", "is a brace, a bracket or a '*' one too many?")
        return self.clean(event.value, place), place

    def clean(self, text: str, place: Place) -> str:
        """A text that may have been written with escapes; what would steer a terminal is refused as in the open."""
        bad = None if text.isprintable() else STEERING.search(text)
        if bad is not None:
            found = f"a control character (U+{ord(bad[0]):04X}) stands in this text"
            self.problems.append(problem(place, "", found, "remove it"))
        return text

    def alias(self, anchor: Any, place: Place, path: tuple[Part, ...], key: Place | None) -> Node:
        if anchor not in self.anchors:
            raise self.stop(
                place, path, f"no anchor {shown('&' + anchor)} before this", did_you_mean(anchor, self.anchors)
            )
        node, size = self.anchors[anchor]
        self.count(size, place, path)
        return replace(node, key=key)

    def count(self, n: int, place: Place, path: tuple[Part, ...]) -> None:
        self.budget.n_nodes += n
        if self.budget.n_nodes > MOST_NODES:
            raise self.stop(
                place, path[:3], f"the file holds more than {MOST_NODES:,} values", "are aliases nested in aliases?"
            )

    def place(self, event: Any) -> Place:
        return Place(self.source, event.start_mark.line, event.start_mark.column)

    def stop(self, place: Place, path: tuple[Part, ...], message: str, hint: str) -> ScenarioError:
        """Nothing can be read beyond this; what was found before is said too."""
        return ScenarioError(sorted([*self.problems, problem(place, path, message, hint)]))

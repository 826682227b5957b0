"""What the YAML parser says, in plain words."""

from __future__ import annotations

import re

import yaml

from opsim.problems import Problem, shown
from opsim.scenario.positions import Place, Source, problem

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

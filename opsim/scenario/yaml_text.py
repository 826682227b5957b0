"""The bytes of a file -> its text, bounded in size; what is no text is refused with the place of the bad byte."""

from __future__ import annotations

from pathlib import Path

from opsim.problems import Problem, ScenarioError
from opsim.scenario import yaml_words
from opsim.scenario.positions import Place, Source, problem

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
    bad = yaml_words.NOT_PRINTABLE.search(text)
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

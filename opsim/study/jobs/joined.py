"""Folders of one study put together: first all is checked, then something is written."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

from opsim.scenario.changes import flow_text
from opsim.study.jobs.answer import Answer
from opsim.study.jobs.answers import Answers
from opsim.study.jobs.folder import ANSWERS, OtherStudy
from opsim.study.jobs.header import HEADER, Header, differing, read_header
from opsim.study.jobs.journal import Journal
from opsim.study.jobs.shard import Missing, Shard

MOST_SHOWN = 8


def one_header(folders: Sequence[Path]) -> Header:
    """The header that all folders have. Raises OtherStudy with every folder that holds another study, or none."""
    headers = {folder: _header(folder) for folder in folders}
    first, *others = headers
    wrong = []
    for folder in others:
        differ = differing(headers[first], headers[folder]) or _asked_differ(headers[first], headers[folder])
        if differ:
            wrong.append(f"{folder} is not of the same study as {first}: {'; '.join(differ)}")
    if wrong:
        raise OtherStudy("\n".join(wrong))
    return headers[first]


def journals_of(folders: Sequence[Path]) -> list[Path]:
    """Every file of answers in the folders."""
    return [path for folder in dict.fromkeys(folders) for path in sorted((folder / ANSWERS).glob("*.jsonl"))]


def one_journal(files: Sequence[Path]) -> Journal:
    """All answers of some files, to be read. Raises OSError, OtherStudy where two give the same job other answers."""
    joined = Journal(files)
    if joined.twice:
        joined.close()
        raise OtherStudy(
            f"two files give other answers to the same replication: {'; '.join(joined.twice[:MOST_SHOWN])}"
        )
    return joined


def copy_answers(answers: Answers, before: Journal, to: Journal) -> None:
    """Every answer that was asked for goes where it is not yet. Raises OSError."""
    for address in answers.addresses():
        if address not in to:
            keys = json.dumps([list(key) for key in before.keys(address)], ensure_ascii=False)
            to.add(address, Answer(keys, tuple(before.values(address))))


def missing_words(missing: Missing, header: Header, folders: Sequence[Path], files: Sequence[Path]) -> str:
    """What is missing, and the commands that make it."""
    shards = {shard: path for path in files if (shard := Shard.of_file(path.name)) is not None}
    lacking = f"{len(missing.places)} of {missing.of} replications are missing"
    counts = {shard.of for shard in shards}
    if len(counts) != 1:
        return f"{lacking}; this makes them:\n  {header.command} -o {folders[0]}"
    of = counts.pop()
    lines = []
    for number, lost in sorted(Counter(place % of + 1 for place in missing.places).items()):
        shard = Shard(number, of)
        there = "is not there" if shard not in shards else f"is not finished, {lost} of its replications are missing"
        folder = shards[shard].parent.parent if shard in shards else folders[0]
        lines.append(f"shard {shard} {there}; this makes it:\n  {header.command} --shard {shard} -o {folder}")
    more = [f"and {len(lines) - MOST_SHOWN} shards more"] if len(lines) > MOST_SHOWN else []
    return "\n".join([lacking, *lines[:MOST_SHOWN], *more])


def _header(folder: Path) -> Header:
    if not (folder / HEADER).is_file():
        raise OtherStudy(f"{folder}: no study here (no {HEADER}); the folders of its shards are wanted")
    return read_header(folder)


def _asked_differ(first: Header, other: Header) -> list[str]:
    """In words, what was asked otherwise: the jobs of a shard are counted in what was asked."""
    words = []
    if first.replications != other.replications:
        words.append(f"replications {first.replications or 'as the file says'}, there {other.replications}")
    before, now = dict(first.asked), dict(other.asked)
    words += [
        f"{key} {flow_text(before.get(key))}, there {flow_text(now.get(key))}"
        for key in {**before, **now}
        if before.get(key) != now.get(key)
    ]
    return words

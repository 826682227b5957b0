"""The hierarchy of an Acclaim skeleton: is every bone below the root?"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from emulator.recordings.acclaim import ROOT
from emulator.recordings.text import quoted


def hung_on_root(bones: Sequence[str], parent: Mapping[str, str]) -> tuple[tuple[int, ...], dict[str, str]]:
    """Parents by number, the root first, and for each bone that does not hang on the root what is wrong with it.

    parent : the parent of each bone by name; a bone may be missing, or be its own ancestor. Each is looked at once.
    """
    numbers = {name: i for i, name in enumerate((ROOT, *bones))}
    seen, loose = {ROOT}, {}
    for name in bones:
        path: dict[str, None] = {}
        at = name
        while at not in seen and at not in path and at in parent:
            path[at] = None
            at = parent[at]
        if at in path:
            loose[at] = f"found {quoted(at)} to be its own ancestor, expected a tree below the root"
        elif at not in seen:
            path[at] = None
            loose[at] = f"found {quoted(at)} below no bone, expected it in :hierarchy"
        seen.update(path)
    return (-1, *(numbers[parent[name]] for name in bones if name in parent)), loose

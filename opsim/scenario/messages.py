"""Options of verbs that have another name in a scenario file: who writes the option there is told the key.

What the schema finds wrong, in plain words and at its place.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from typing import Any, get_args, get_origin

from pydantic import ValidationError
from pydantic.fields import FieldInfo

from opsim.problems import Problem, did_you_mean, nearest, shown
from opsim.scenario import templates
from opsim.scenario.fields import of_per_cent
from opsim.scenario.schema import TASK_KINDS, Block, Path, Place, Scenario, Step
from opsim.scenario.schema.subjects import scenario_model
from opsim.scenario.tree import Node, Part, child, dotted, problem
from opsim.scenario.yaml import scalar
from opsim.subjects.breakdowns.words import CYCLE_KINDS, SO_MANY
from opsim.subjects.human.effect_blocks import MODEL_TAGS
from opsim.subjects.people.words import RATING, SKILL, Skill
from opsim.subjects.tasks.words import BY_PRODUCT, HEIGHT, LAYERS, Layers

_IN_RUN = {"seed": "run.seed", "horizon": "run.horizon", "warm_up": "run.warm_up"}
_BUY_BACK = {key: f"buy_back.{key}" for key in ("like", "most_workers", "most_skills")}
_KEYS = {
    "sweep": {"figure": "figures"},
    "select": {"best": "figure", "among": "variants", "most": "most_replications"},
    "labour": {"figure": "figures", "no_budget": "budget: off", "no_buy_back": "buy_back: off", **_BUY_BACK},
    "layout": {},
}
"""By verb: an option, and where in the file it stands."""


def option_hint(path: tuple[Part, ...]) -> str:
    """What to write instead of an option among the keys of a study; empty where the key is none that an option has."""
    if len(path) != 3 or path[0] != "studies":
        return ""
    verb, word = str(path[1]), str(path[2]).strip("-").replace("-", "_")
    option = f"--{word.replace('_', '-')}"
    if verb in _KEYS and word in _IN_RUN:
        return f"{option} is {_IN_RUN[word]} in a file"
    key = _KEYS.get(verb, {}).get(word, "")
    if not key:
        return ""
    return f"the key of {option} is '{key}'" if key.isidentifier() else f"{option} is {key} in a file"


_HERE = "keys here"
_FORMS = (RATING, SKILL, SO_MANY, *CYCLE_KINDS, *MODEL_TAGS)
_WAYS = ("<at>", "<place>", "<places>", "<path>", HEIGHT, LAYERS, BY_PRODUCT)
_MARKS = ("[key]", "<time>", "<model>", *_WAYS, "<motion>", "<step>", "<range>", "<values>", *_FORMS)
_TYPES = {
    "string_type": "text",
    "int_type": "a whole number",
    "float_type": "a number",
    "bool_type": "true or false",
    "list_type": "a list",
    "dict_type": "a block of names",
    "model_type": "a block of keys",
    "model_attributes_type": "a block of keys",
}
_BOUNDS = {
    "greater_than": ("more than", "gt"),
    "greater_than_equal": ("at least", "ge"),
    "less_than": ("less than", "lt"),
    "less_than_equal": ("at most", "le"),
}


def schema_problems(error: ValidationError, tree: Node, lacking_keys: Collection[str] = ()) -> Iterator[Problem]:
    """Every error of a validation as a problem at its place in the tree.

    lacking_keys : paths of blocks whose keys were to come from elsewhere; those they miss are no mistakes of their own
    """
    missing: dict[tuple[Part, ...], list[str]] = {}
    meant: set[tuple[Part, ...]] = set()
    for item in error.errors(include_url=False, include_input=False):
        loc, on = item["loc"], _key_meant(item, tree)
        if item["type"] == "missing":
            missing.setdefault(loc[:-1], []).append(str(loc[-1]))
        else:
            if item["type"] == "extra_forbidden":
                meant.add((*loc[:-1], nearest(loc[-1], keys_allowed(loc[:-1])) or ""))
            yield _in_words(dict(item), (*_path(loc), on) if on is not None else _path(loc), tree)
    for loc, keys in missing.items():
        lacking = [key for key in keys if (*loc, key) not in meant]  # a mistyped key is one mistake, not two
        if lacking and dotted(_path(loc)) not in lacking_keys:
            yield _missing(loc, lacking, tree)


def _key_meant(item: Any, tree: Node) -> Part | None:
    """The key inside the block that an error is about; of two, that which comes from elsewhere, as from an option."""
    ctx = item.get("ctx", {})
    on, other = ctx.get("on"), ctx.get("or_on")
    nodes = [child(tree, *_path(item["loc"]), key) for key in (on, other) if key]
    elsewhere = [node is not None and node.place.source.file != tree.place.source.file for node in nodes]
    return other if elsewhere == [False, True] else on


def _path(loc: tuple[Part, ...]) -> tuple[Part, ...]:
    """A location without the marks the schema puts in: which kind of task or of gap, that it is a key."""
    return tuple(part for part in loc if part not in TASK_KINDS and part not in _MARKS)


def _in_words(item: dict[str, Any], path: tuple[Part, ...], tree: Node) -> Problem:
    kind, ctx = item["type"], item.get("ctx", {})
    if kind == "extra_forbidden":
        hint = _block_above(path) or option_hint(path) or _nearest_key(path[-1], keys_allowed(item["loc"][:-1]))
        return problem(_key_place(tree, path), path, f"unknown key {shown(path[-1])}", _nobodys(path, hint))
    node = _deepest(tree, path)
    if kind == "plain":
        place = node.name_place if item["loc"][-1:] == ("[key]",) or node.value is None else node.place
        return problem(place, path, ctx["message"], ctx["hint"])
    message, hint = _wrong_value(kind, ctx, node.value)
    hint = hint or _such_as(kind, ctx, item["loc"])
    return problem(node.name_place if node.value is None else node.place, path, message, hint)


def _nearest_key(key: Part, known: list[str]) -> str:
    return did_you_mean(key, known, otherwise=_HERE, most=len(known))


def _nobodys(path: tuple[Part, ...], hint: str) -> str:
    """Of a key where a subject of somebody else may stand: whether one is missing."""
    may_stand = len(path) == 1 or (len(path) == 3 and path[0] == "stations")
    return f"no installed package knows this word; {hint}" if may_stand and hint.startswith(_HERE) else hint


def _block_above(path: tuple[Part, ...]) -> str:
    """Where a key stands in an effect and is one of all effects."""
    if len(path) == 3 and path[0] == "human" and path[2] in ("acts_on", "absence"):
        return f"'{path[2]}' stands under 'human' itself, beside '{path[1]}'"
    return ""


def _wrong_value(kind: str, ctx: dict[str, Any], value: object) -> tuple[str, str]:
    found = f"found {shown(value)}"
    if kind in _TYPES:
        return f"expected {_TYPES[kind]}, {found}", _type_hint(kind, value)
    if kind in _BOUNDS:
        words, bound = _BOUNDS[kind]
        return f"must be {words} {ctx[bound]:.12g}, {found}", _bound_hint(bound, ctx[bound], value)
    if kind == "literal_error":
        known = [word.strip("' ") for word in ctx["expected"].replace(" or ", ",").split(",")]
        return f"expected {_either(known)}, {found}", _near(value, known)
    if kind == "finite_number":
        return f"expected a finite number, {found}", ""
    if kind in ("too_short", "too_long"):
        return _wrong_number(kind, ctx), ""
    if kind in ("string_too_short", "string_too_long"):
        words = "at least one character" if kind == "string_too_short" else f"at most {ctx['max_length']} characters"
        return f"expected {words}, {found}", ""
    return f"cannot be read, {found}", ""


def _such_as(kind: str, ctx: dict[str, Any], loc: tuple[Part, ...]) -> str:
    """The example of a key, or of a block's keys that it must have, where something of another shape stands."""
    if kind not in ("dict_type", "model_type", "list_type", "too_short", "bool_type"):
        return ""
    field = _fields(_model_at(loc[:-1])).get(str(loc[-1]))
    if kind == "bool_type":
        default = None if field is None or field.is_required() else field.default
        return "" if default is None else f"without the line it is {shown(default)}"
    if kind == "model_type":
        model = _model_at(loc)
        needed = {key: field for key, field in _fields(model).items() if field.is_required()}
        said = ", ".join(f"{key}: {field.examples[0]}" for key, field in needed.items() if field.examples)
        return f"such as {{{said}}}" if said and model.__name__ == ctx.get("class_name") else ""
    if field is None or not field.examples:
        return ""
    return f"such as {field.examples[0]}" + (", or remove the line" if not field.is_required() else "")


def _fields(model: type[Block]) -> dict[str, FieldInfo]:
    """The keys of a block, as they are written in the file."""
    return {field.alias or name: field for name, field in model.model_fields.items()}


def _bound_hint(bound: str, limit: float, value: object) -> str:
    if bound in ("gt", "lt"):
        return f"write a number {'above' if bound == 'gt' else 'below'} {limit:g}"
    if isinstance(value, int | float) and value < 0 <= limit <= -value:
        return f"write {shown(-value)}, without the minus"
    return f"write {limit:.12g} or {'more' if bound == 'ge' else 'less'}"


def _wrong_number(kind: str, ctx: dict[str, Any]) -> str:
    bound, words = (ctx["min_length"], "at least") if kind == "too_short" else (ctx["max_length"], "at most")
    entries = "one entry" if bound == 1 else f"{bound:,} entries"
    return f"expected {words} {entries}, found {ctx['actual_length'] or 'none'}"


def _either(words: list[str]) -> str:
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} or {words[-1]}"


def _near(value: object, known: list[str]) -> str:
    near = nearest(value, known) if isinstance(value, str) else None
    return f"did you mean {shown(near)}?" if near else ""


def _type_hint(kind: str, value: object) -> str:
    if kind == "string_type" and isinstance(value, int | float):
        return f"write it in quotes: '{shown(value)}'"
    if value is None:
        return "fill it, or remove the line"
    if kind == "list_type" and isinstance(value, str):
        return f"write [{value}]" if len(value) < 40 else "write it in [ ]"
    if kind != "float_type" or not isinstance(value, str):
        return ""
    return "remove the quotes" if isinstance(scalar(value), int | float) else of_per_cent(value)


def _missing(loc: tuple[Part, ...], keys: list[str], tree: Node) -> Problem:
    """The keys that a block lacks, said at the block."""
    path = _path(loc)
    names = [shown(key) for key in keys]
    listed = names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"
    found = f"{listed} {'is' if len(names) == 1 else 'are'} missing"
    return problem(_deepest(tree, path).name_place, path, found, _example(loc, keys[0]))


def _example(loc: tuple[Part, ...], key: str) -> str:
    fields = _fields(_model_at(loc))
    examples = fields[key].examples if key in fields else None
    return f"add e.g. '{key}: {examples[0]}'" if examples else f"add '{key}:'"


def keys_allowed(loc: tuple[Part, ...]) -> list[str]:
    """The keys a block at a location may have, as they are written in the file."""
    model = _model_at(loc)
    keys = [field.alias or name for name, field in model.model_fields.items()]
    if issubclass(model, Scenario):
        return [*keys, "include", "defaults", "overrides", "scenarios"]
    return [*keys, "like"] if loc and loc[0] in (*templates.SECTIONS, templates.WORKFORCE) else keys


def _model_at(loc: tuple[Part, ...]) -> type[Block]:
    """The block at a location, found by walking down the models; marks say which kind of a task, a path, a step."""
    marked: dict[str, type[Block]] = {"<place>": Place, "<path>": Path, "<step>": Step, LAYERS: Layers, SKILL: Skill}
    marked |= TASK_KINDS | MODEL_TAGS | CYCLE_KINDS
    model: type[Block] = scenario_model()
    parts = iter(loc)
    for part in parts:
        if isinstance(part, str) and part in marked:
            model = marked[part]
            continue
        inside = _block_in(_annotations(model).get(str(part)))
        if inside is not None:
            model, n_names = inside
            for _ in range(n_names):
                next(parts, None)
    return model


def _annotations(model: type[Block]) -> dict[str, Any]:
    """What stands at each key of a block, by its name in the file."""
    return {field.alias or name: field.annotation for name, field in model.model_fields.items()}


def _block_in(annotation: Any) -> tuple[type[Block], int] | None:
    """The first block inside a type, and how many names or numbers lead from the key to it."""
    if isinstance(annotation, type) and issubclass(annotation, Block):
        return annotation, 0
    found = next((one for inside in get_args(annotation) if (one := _block_in(inside)) is not None), None)
    by_name = get_origin(annotation) in (dict, list)
    return found if found is None else (found[0], found[1] + by_name)


def _deepest(tree: Node, path: tuple[Part, ...]) -> Node:
    """The node at a path, or the last one on the way that exists."""
    while path and child(tree, *path) is None:
        path = path[:-1]
    return child(tree, *path) or tree


def _key_place(tree: Node, path: tuple[Part, ...]) -> Any:
    return _deepest(tree, path).name_place

"""A small validator of JSON Schema draft 07: the words our schema uses, and no other."""

import re

TYPES = {
    "object": dict,
    "array": list,
    "string": str,
    "integer": int,
    "number": (int, float),
    "boolean": bool,
}
SAID_ONLY = {"$schema", "$id", "title", "description", "examples", "default", "definitions", "enumDescriptions"}


def complaints(value, schema, root=None, path=""):
    """Everything a schema finds wrong with a value, each with its path. Raises KeyError for a word it does not know."""
    root = schema if root is None else root
    schema = {} if schema is True else schema
    if "$ref" in schema:
        yield from complaints(value, root["definitions"][schema["$ref"].removeprefix("#/definitions/")], root, path)
    for word in schema.keys() - SAID_ONLY - {"$ref"}:
        yield from WORDS[word](value, schema[word], schema, root, path)


def fine(value, schema, root):
    return not list(complaints(value, schema, root))


def _type(value, wanted, schema, root, path):
    kinds = wanted if isinstance(wanted, list) else [wanted]
    if not any(_is_a(value, kind) for kind in kinds):
        yield f"{path}: not a {' or '.join(kinds)}"


def _is_a(value, kind):
    return isinstance(value, TYPES[kind]) and not (isinstance(value, bool) and kind in ("integer", "number"))


def _properties(value, wanted, schema, root, path):
    for key in wanted.keys() & (value if isinstance(value, dict) else {}):
        yield from complaints(value[key], wanted[key], root, f"{path}.{key}")


def _additional(value, wanted, schema, root, path):
    for key in (value if isinstance(value, dict) else {}).keys() - schema.get("properties", {}).keys():
        if wanted is False:
            yield f"{path}: unknown key {key}"
        else:
            yield from complaints(value[key], wanted, root, f"{path}.{key}")


def _items(value, wanted, schema, root, path):
    for number, one in enumerate(value if isinstance(value, list) else []):
        here = wanted[number] if isinstance(wanted, list) and number < len(wanted) else wanted
        if isinstance(here, dict):
            yield from complaints(one, here, root, f"{path}[{number}]")


def _required(value, wanted, schema, root, path):
    for key in wanted if isinstance(value, dict) else ():
        if key not in value:
            yield f"{path}: {key} is missing"


def _any_of(value, wanted, schema, root, path):
    if not any(fine(value, one, root) for one in wanted):
        yield f"{path}: none of {len(wanted)} fits"


def _all_of(value, wanted, schema, root, path):
    for one in wanted:
        yield from complaints(value, one, root, path)


def _if(value, wanted, schema, root, path):
    yield from complaints(value, schema["then"], root, path) if fine(value, wanted, root) else ()


def _not(value, wanted, schema, root, path):
    if fine(value, wanted, root):
        yield f"{path}: must not be so"


def _names(value, wanted, schema, root, path):
    for key in value if isinstance(value, dict) else ():
        yield from complaints(key, wanted, root, f"{path}.{key}")


def _number(good):
    def check(value, wanted, schema, root, path):
        if isinstance(value, int | float) and not isinstance(value, bool) and not good(value, wanted):
            yield f"{path}: {value} is beyond {wanted}"

    return check


def _length(kind, good):
    def check(value, wanted, schema, root, path):
        if isinstance(value, kind) and not good(len(value), wanted):
            yield f"{path}: {len(value)} entries are beyond {wanted}"

    return check


def _pattern(value, wanted, schema, root, path):
    if isinstance(value, str) and re.search(wanted, value) is None:
        yield f"{path}: {value!r} does not look right"


def _is(value, wanted, schema, root, path):
    if value not in (wanted if isinstance(wanted, list) else [wanted]) or isinstance(value, bool):
        yield f"{path}: {value!r} is not among {wanted}"


WORDS = {
    "type": _type,
    "properties": _properties,
    "additionalProperties": _additional,
    "propertyNames": _names,
    "items": _items,
    "required": _required,
    "anyOf": _any_of,
    "allOf": _all_of,
    "if": _if,
    "then": lambda *_: (),
    "not": _not,
    "pattern": _pattern,
    "enum": _is,
    "const": _is,
    "minimum": _number(lambda a, b: a >= b),
    "maximum": _number(lambda a, b: a <= b),
    "exclusiveMinimum": _number(lambda a, b: a > b),
    "exclusiveMaximum": _number(lambda a, b: a < b),
    "minItems": _length(list, lambda a, b: a >= b),
    "maxItems": _length(list, lambda a, b: a <= b),
    "minProperties": _length(dict, lambda a, b: a >= b),
    "minLength": _length(str, lambda a, b: a >= b),
    "maxLength": _length(str, lambda a, b: a <= b),
}

"""The language as a JSON Schema (draft 07) for editors, made from the models that check a scenario.

An editor sees one file and no files it includes; so what ``like``, ``defaults`` or ``include`` may supply is asked for
only where none of them stands. Names that lead nowhere are found by ``opsim check`` alone.
"""

from __future__ import annotations

import json
from typing import Any

import yaml

from opsim import units
from opsim.kpi.catalogue import CATALOGUE
from opsim.scenario.fields import NAME_PATTERN
from opsim.scenario.schema import KIND_KEYS
from opsim.scenario.schema.subjects import scenario_model
from opsim.scenario.templates import SECTIONS

Schema = dict[str, Any]
FILE_NAME = "opsim.schema.json"
DRAFT = "http://json-schema.org/draft-07/schema#"
"""NOTE: not 2020-12: of the editors' checkers not all know it; what is said here means the same in both."""
ID = "urn:opsim:scenario:1"
"""A name, no address: the schema lies beside the scenario, and nothing is fetched."""
_NOISE = ("title", "quantity")
_LIKE = {"type": "string", "description": "the entry that is copied", "examples": ["ana"]}
_JOBS_COME_IN = {"anyOf": [{"required": ["release"]}, {"required": ["sources"]}]}


def json_schema() -> Schema:
    """The whole schema as plain values, ready for ``json.dumps``."""
    schema = _plain(scenario_model().model_json_schema())
    properties, definitions = schema["properties"], schema["definitions"]
    definitions = schema["definitions"] = {name: {"title": name, **one} for name, one in definitions.items()}
    _sharpen(properties, definitions)
    full = {section: properties[section]["additionalProperties"] for section in SECTIONS}
    copied = {_name_of(one) for entry in full.values() for one in entry.get("anyOf", [entry])}
    for name in (*copied, "Workforce"):
        definitions[name]["properties"]["like"] = _LIKE
    needed = {section: _unless_like(_needed(entry, definitions)) for section, entry in full.items()}
    needed["products"] = _unless_like({"anyOf": [{"required": ["route"]}, {"required": ["routing"]}]})
    for name in copied:
        definitions[name].pop("required", None)
    required = schema.pop("required")
    return {
        "$schema": DRAFT,
        "$id": ID,
        "title": "opsim scenario",
        "description": "A scenario of opsim: production whose work is done by people.",
        **schema,
        "properties": {**properties, **_of_the_file(properties)},
        "required": ["opsim"],
        "allOf": [
            {"if": {"not": {"required": ["include"]}}, "then": {"required": required, **_JOBS_COME_IN}},
            {
                "if": {"not": {"anyOf": [{"required": ["include"]}, {"required": ["defaults"]}]}},
                "then": {"properties": {section: {"additionalProperties": one} for section, one in needed.items()}},
            },
        ],
    }


def _plain(node: Any) -> Any:
    """Draft 07, without titles that only repeat a key, and without null: a key that says nothing is left out."""
    if isinstance(node, list):
        return [_plain(one) for one in node]
    if not isinstance(node, dict):
        return str(node).replace("#/$defs/", "#/definitions/") if isinstance(node, str) else node
    if "properties" in node:  # keys of a scenario, which may be called as words of the schema
        inside = {key: _plain(value) for key, value in node["properties"].items()}
        return {**_plain({key: value for key, value in node.items() if key != "properties"}), "properties": inside}
    renamed = {"$defs": "definitions", "oneOf": "anyOf", "prefixItems": "items", "ge": "minimum", "le": "maximum"}
    told = _told(_without_null(node))
    return {renamed.get(key, key): _plain(value) for key, value in told.items() if key not in _NOISE}


def _without_null(node: Schema) -> Schema:
    """``anyOf: [X, null]`` is X, with what stands beside it; a default of nothing goes."""
    ways = [one for one in node.get("anyOf", []) if one != {"type": "null"}]
    if "anyOf" in node:
        rest = {key: value for key, value in node.items() if key != "anyOf"}
        node = {**ways[0], **rest} if len(ways) == 1 else {**rest, "anyOf": ways}
    if isinstance(node.get("default"), dict):
        node = {**node, "default": {key: value for key, value in node["default"].items() if value is not None}}
    return {key: value for key, value in node.items() if not (key == "default" and value in (None, {}))}


def _told(node: Schema) -> Schema:
    """A quantity says its units, and its default with one; examples are values, not text of a file."""
    if "quantity" in node:
        kind = node["quantity"]
        known = f"{units.a(kind)} in {', '.join(units.UNITS[kind])}"
        node = {**node, "description": f"{node['description']}; {known}" if "description" in node else known}
        if isinstance(node.get("default"), int | float):
            node = {**node, "default": units.written(node["default"], kind)}
    elif isinstance(node.get("examples"), list) and node.get("type") != "string":
        node = {**node, "examples": [yaml.safe_load(one) if isinstance(one, str) else one for one in node["examples"]]}
    return node


def _sharpen(properties: Schema, definitions: Schema) -> None:
    """What validators know and the models' own schema does not say."""
    station, layout, product = (definitions[name]["properties"] for name in ("Station", "Layout", "Product"))
    definitions["Run"]["properties"]["start"]["pattern"] = "^\\s*[A-Za-z]+\\s+[0-9]{1,2}:[0-9]{2}\\s*$"
    buffer = station["buffer"]
    whole = {"type": buffer.pop("type"), "minimum": buffer.pop("minimum"), "maximum": buffer.pop("maximum")}
    buffer["anyOf"] = [whole, {"const": "unlimited"}]
    for people in ("Worker", "Workforce"):
        pace, _ = definitions[people]["properties"]["skills"]["additionalProperties"]["anyOf"]
        pace["type"] = ["number", "string"]
    ways = product["routing"]["additionalProperties"]
    product["routing"]["additionalProperties"] = {"anyOf": [{"type": "string"}, ways]}
    for named in [properties[name] for name in (*SECTIONS, "libraries", "skill_levels")] + [layout["places"]]:
        named["propertyNames"] = {"pattern": NAME_PATTERN, "maxLength": 100}
    meaning = [f"{one.title} [{one.unit}]" if one.unit else one.title for one in CATALOGUE.values()]
    properties["outputs"]["items"] = {"enum": list(CATALOGUE), "enumDescriptions": meaning}
    bought = definitions["Labour"]["properties"]["buy_back"]
    bought["anyOf"] = [{"$ref": bought.pop("$ref")}, {"enum": ["off"]}, {"type": "boolean"}]


def _needed(entry: Schema, definitions: Schema) -> Schema:
    """What an entry must say, by its kind where there are several."""
    if "anyOf" not in entry:
        return {"required": definitions[_name_of(entry)].get("required", [])}
    ways = []
    for one in entry["anyOf"]:
        model = definitions[_name_of(one)]
        kind = {key: model["properties"][key] for key in KIND_KEYS if key in model["properties"]}
        ways.append({"title": model["title"], "required": model["required"], "properties": kind})
    return {"anyOf": ways}


def _unless_like(needed: Schema) -> Schema:
    return {"if": {"not": {"required": ["like"]}}, "then": needed}


def _of_the_file(properties: Schema) -> Schema:
    """The keys that are of the file and not of a variant."""
    block = {"type": "object"}
    return {
        "include": {
            "description": "files laid below this one; of two, the later wins",
            "anyOf": [{"type": "string"}, {"type": "array", "items": {"type": "string"}}],
            "examples": [["common.yaml"]],
        },
        "defaults": {
            "description": "what every entry of a section starts from",
            "additionalProperties": False,
            "properties": {
                section: {**properties[section]["additionalProperties"], "description": f"of each of the {section}"}
                for section in SECTIONS
            },
            "examples": [{"stations": {"servers": 2}}],
            **block,
        },
        "overrides": {
            "description": "named changes: dotted paths and their new values",
            "additionalProperties": block,
            "examples": [{"near": {"layout.places.rack": ["6 m", "1 m"]}}],
            **block,
        },
        "scenarios": {
            "description": "variants of this file, each a list of overrides",
            "additionalProperties": {"type": "array", "items": {"type": "string"}},
            "examples": [{"base": [], "near": ["near"]}],
            **block,
        },
    }


def _name_of(reference: Schema) -> str:
    return str(reference["$ref"]).rpartition("/")[2]


def schema_text() -> str:
    """The schema as the text of a file."""
    return json.dumps(json_schema(), indent=1, ensure_ascii=False) + "\n"

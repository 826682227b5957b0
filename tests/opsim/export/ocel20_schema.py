"""What the JSON schema of OCEL 2.0 asks for, written down again from it, so that tests need no network.

Source: https://www.ocel-standard.org/2.0/ocel20-schema-json.json (draft 07), of Berti, Koren, Adams and others: OCEL
(Object-Centric Event Log) 2.0 Specification, arXiv:2403.01975, CC BY 4.0. Every value of an attribute is a string
there; its type says what it means.
"""

_TEXT = {"type": "string"}
_TIME = {"type": "string", "format": "date-time"}


def _listed(required, **properties):
    return {"type": "array", "items": {"type": "object", "properties": properties, "required": required}}


_TYPES = _listed(["name", "attributes"], name=_TEXT, attributes=_listed(["name", "type"], name=_TEXT, type=_TEXT))
_RELATED = _listed(["objectId", "qualifier"], objectId=_TEXT, qualifier=_TEXT)
SCHEMA = {
    "$schema": "http://json-schema.org/draft-07/schema#",
    "type": "object",
    "properties": {
        "eventTypes": _TYPES,
        "objectTypes": _TYPES,
        "events": _listed(
            ["id", "type", "time"],
            id=_TEXT,
            type=_TEXT,
            time=_TIME,
            attributes=_listed(["name", "value"], name=_TEXT, value=_TEXT),
            relationships=_RELATED,
        ),
        "objects": _listed(
            ["id", "type"],
            id=_TEXT,
            type=_TEXT,
            relationships=_RELATED,
            attributes=_listed(["name", "value", "time"], name=_TEXT, value=_TEXT, time=_TIME),
        ),
    },
    "required": ["eventTypes", "objectTypes", "events", "objects"],
}
ATTRIBUTE_TYPES = {"string", "time", "integer", "float", "boolean"}
"""Section 8 of the specification; the schema itself says no more than that a type is a string."""

"""The models of human effects as blocks, ``{model: NAME, ...}``, made from the catalogue."""

from __future__ import annotations

from collections.abc import Callable
from math import inf
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Discriminator, Field, Tag, create_model, model_validator

from opsim.problems import did_you_mean, shown
from opsim.scenario.fields import Seconds, SecondsOrZero, or_never, plain_error
from opsim.scenario.tree import Block
from opsim.subjects.human.catalogue import EFFECTS, Entry, Parameter, entry, models_of
from opsim.subjects.shifts.words import Clock, clock_text

MODEL_TAGS: dict[str, type[Block]] = {}
"""The mark of each block in a place of pydantic's, such as ``<learning: wright>``."""


def one_of(effect: str) -> Any:
    """The type of an effect: a block for each of its models, told apart by ``model``."""
    names = models_of(effect) if effect in EFFECTS else ()
    if not names:
        return Annotated[Block, BeforeValidator(_not_here(effect))]
    blocks = [_block(entry(effect, name), alone=len(names) == 1) for name in names]
    if len(blocks) == 1:
        return Annotated[blocks[0], BeforeValidator(_names_one(effect, names))]
    ways: Any = None
    for name, block in zip(names, blocks):
        mark = f"<{effect}: {name}>"
        MODEL_TAGS[mark] = block
        one: Any = Annotated[block, Tag(mark)]  # type: ignore[valid-type]
        ways = one if ways is None else ways | one
    return Annotated[ways, Discriminator(_mark_of(effect)), BeforeValidator(_names_one(effect, names))]


def _block(one: Entry, alone: bool) -> type[Block]:
    """The block of one model; its ``model`` need not be said where the effect has no other."""
    fields = {parameter.name: _field(parameter) for parameter in one.parameters}
    named: Any = (Literal[one.model], Field(one.model if alone else ..., description="which model"))
    made: type[Block] = create_model(  # type: ignore[call-overload]
        one.cls.__name__,
        __base__=Block,
        __module__=__name__,
        __doc__=f"{one.does[0].upper()}{one.does[1:]}. Source: {one.source}.",
        __validators__={"_whole": model_validator(mode="after")(_checked_by(one.cls))},
        model=named,
        **fields,
    )
    globals()[made.__name__] = made  # NOTE: where another process that is sent a scenario looks for it
    return made


def _checked_by(cls: type) -> Callable[[Any], Any]:
    """What the model itself refuses, such as parameters that do not go together."""

    def check(self: Any) -> Any:
        try:
            cls(**{name: getattr(self, name) for name in type(self).model_fields if name != "model"})
        except ValueError as error:
            key, _, found = str(error).partition(": ")
            on = {name: field.alias or name for name, field in type(self).model_fields.items()}.get(key)
            raise plain_error(found if on else str(error), on=on) from None
        return self

    return check


def _field(one: Parameter) -> tuple[Any, Any]:
    """Type and field of a parameter, by its unit and bounds."""
    more: dict[str, Any] = {"description": one.meaning}
    default: Any = ... if one.required else one.default
    words = getattr(one, "words", ())
    if words:
        return Literal[tuple(words)], Field(default, **more)
    if one.name == "peak_s":
        return Clock, Field(default, alias="peak", json_schema_extra={"default": clock_text(one.default)}, **more)
    if one.unit == "s":
        kind = Seconds if one.above >= 0 else SecondsOrZero
        alias = one.name.removesuffix("_s")
        return or_never(kind) if one.endless else kind, Field(default, alias=alias, **more)
    bounds = {"ge": one.at_least, "gt": one.above, "le": one.at_most, "lt": one.below}
    more |= {key: bound for key, bound in bounds.items() if abs(bound) != inf}
    return float, Field(default, examples=None if one.required else [default], **more)


def _names_one(effect: str, names: tuple[str, ...]) -> Callable[[object], object]:
    """A block that names one of an effect's models."""

    def read(value: object) -> object:
        if isinstance(value, Block):
            return value
        if not isinstance(value, dict):
            hint = f"write {{model: {value}}}" if isinstance(value, str) and value in names else ""
            raise plain_error(f"expected a block of keys, found {shown(value)}", hint or f"such as {_such(effect)}")
        if "model" not in value and len(names) == 1:
            return value
        if "model" not in value:
            near = next((hint for key in value if (hint := did_you_mean(key, ("model",))).startswith("did")), "")
            raise plain_error(f"nothing says which model of {effect}", near or f"add e.g. 'model: {names[0]}'")
        if not isinstance(value["model"], str) or value["model"] not in names:
            hint = did_you_mean(value["model"], names, otherwise="models")
            raise plain_error(f"no model of {effect} is called {shown(value['model'])}", hint, on="model")
        return value

    return read


def _not_here(effect: str) -> Callable[[object], object]:
    def read(value: object) -> object:
        raise plain_error(f"there is no model of {effect} yet", "remove the line")

    return read


def _such(effect: str) -> str:
    return f"{{model: {models_of(effect)[0]}}}"


def _mark_of(effect: str) -> Callable[[Any], str]:
    return lambda value: f"<{effect}: {value['model'] if isinstance(value, dict) else value.model}>"

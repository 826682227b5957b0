"""What a scenario says to a plug-in: quantities with their units become numbers in SI, all mistakes at once."""

from __future__ import annotations

import inspect
from collections.abc import Iterator, Mapping
from typing import Any

from opsim.plugins.blame import NoSuchPlugin
from opsim.plugins.door import plugins
from opsim.problems import did_you_mean, shown
from opsim.units import UnitError, parse

KIND_OF_ENDING = {"_m_per_s": "speed", "_kg": "mass", "_s": "time", "_m": "length"}
PLUGIN = "plugin"
_BY_NAME = (inspect.Parameter.POSITIONAL_OR_KEYWORD, inspect.Parameter.KEYWORD_ONLY)


def plugin_model(name: str, said: Mapping[str, Any]) -> Any:
    """The TaskModel of the emulator plug-in of that name with what a scenario says to it, e.g. ``{"reach": "40 cm"}``.

    Raises ValueError with every mistake; PluginError and NoSuchPlugin are such too.
    """
    factory = plugins("opsim.emulators")[name]
    given, complaints = _read(factory, said)
    if complaints:
        raise ValueError("; ".join(" ".join(filter(None, complaint[1:])) for complaint in complaints))
    return factory(**given)


def plugin_problems(name: str, said: Mapping[str, Any]) -> list[tuple[str, str, str]]:
    """(key, message, hint) of everything that is wrong with the use of a plug-in; key ``plugin`` for the whole."""
    try:
        _given, complaints = _read(plugins("opsim.emulators")[name], said)
        if not complaints:
            plugin_model(name, said).mean_duration_s()
    except NoSuchPlugin:
        return [(PLUGIN, f"no plug-in {shown(name)}", did_you_mean(name, plugins("opsim.emulators")))]
    except ValueError as error:
        return [(PLUGIN, str(error), "")]
    return complaints


def _read(factory: Any, said: Mapping[str, Any]) -> tuple[dict[str, Any], list[tuple[str, str, str]]]:
    """Numbers by parameter, and the complaints."""
    parameters = {name: p for name, p in inspect.signature(factory).parameters.items() if p.kind in _BY_NAME}
    key_of = {parameter: _key_and_kind(parameter)[0] for parameter in parameters}
    parameter_of = {key: parameter for parameter, key in key_of.items()}
    given: dict[str, Any] = {}
    complaints = [*_unknown(said, parameter_of), *_missing(said, parameters, key_of)]
    for key, value in said.items():
        if key in parameter_of:
            try:
                given[parameter_of[key]] = _value(value, _key_and_kind(parameter_of[key])[1])
            except UnitError as error:
                complaints.append((key, error.message, error.hint))
    return given, complaints


def _unknown(said: Mapping[str, Any], known: Mapping[str, str]) -> Iterator[tuple[str, str, str]]:
    for key in said:
        if key not in known:
            yield key, f"no parameter {shown(key)}", did_you_mean(key, known, otherwise="parameters")


def _missing(said: Mapping[str, Any], parameters: Mapping[str, Any], key_of: Mapping[str, str]) -> Iterator[tuple]:
    for name, parameter in parameters.items():
        if parameter.default is parameter.empty and key_of[name] not in said:
            kind = _key_and_kind(name)[1]
            yield PLUGIN, f"needs {shown(key_of[name])}", f"a {kind}" if kind else ""


def _key_and_kind(parameter: str) -> tuple[str, str]:
    """``reach_m`` -> ("reach", "length"); a name without such an ending stays as it is, with no kind."""
    for ending, kind in KIND_OF_ENDING.items():
        if parameter.endswith(ending) and len(parameter) > len(ending):
            return parameter.removesuffix(ending), kind
    return parameter, ""


def _value(value: Any, kind: str) -> Any:
    return parse(value, kind) if kind else value

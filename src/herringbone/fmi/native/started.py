"""A component with start values of its own, as one instance of a system has them."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from fmpy.model_description import ModelDescription

from herringbone.components.registry import COMPONENTS
from herringbone.core import HerringboneError
from herringbone.core.declaring.started import with_starts
from herringbone.fmi.description.common import identifier
from herringbone.fmi.native.build import build_models
from herringbone.fmi.native.model import Model, registered_model


def build_started_fmu(
    name: str,
    values: Mapping[str, float | str],
    *,
    files: Mapping[str, Path] | None = None,
    platforms: Sequence[str] = (),
) -> Path:
    """Build the native FMU (FMI 2.0) of a component that starts with values, whoever runs it.

    Only the part of the library that holds the declaration is compiled for it.

    Args:
        name: of the component.
        values: start values by variable or String parameter.
        files: see `registered_model`.
        platforms: see `build_native_fmus`.

    Raises:
        HerringboneError: there is no such variable, or see `build_native_fmus`.
    """
    model = _started(name, values, files)
    (built,) = build_models([model], platforms=platforms).values()
    return built


def starts_of_own_fmu(model: ModelDescription) -> dict[str, float | str] | None:
    """Start values with which these sources built an FMU of a component; None if they did not."""
    name = model.coSimulation.modelIdentifier
    if name not in COMPONENTS:
        return None
    declaration = COMPONENTS[name].declaration
    given = {v.name: v.start for v in model.modelVariables if v.start is not None}
    try:
        values: dict[str, float | str] = {
            v.name: float(given[v.name])
            for v in declaration.variables
            if v.name in given and float(given[v.name]) != v.start
        }
    except ValueError:
        return None
    values |= {
        text.name: given[text.name]
        for text in declaration.texts
        if given.get(text.name, text.start) != text.start
    }
    try:
        own = _started(name, values, None)
        same = model.guid == identifier(own.component, own.states.built_with)
    except (KeyError, HerringboneError):  # a resource that lies in that FMU alone
        return None
    return values if same else None


def _started(
    name: str, values: Mapping[str, float | str], files: Mapping[str, Path] | None
) -> Model:
    """The model of a component with other start values."""
    model = registered_model(name, files)
    started = with_starts(model.component.declaration, values)
    return replace(model, component=replace(model.component, declaration=started), shipped=False)

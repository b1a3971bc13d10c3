"""Declarations that everything else is derived from: variables, blocks, units, errors, outcomes."""

from herringbone.core.component import Component, Kernels
from herringbone.core.declaration import Declaration
from herringbone.core.errors import (
    EquilibriumError,
    FmuError,
    HerringboneError,
    ParameterError,
    ResourceError,
    StructureError,
    one_line,
    reason,
)
from herringbone.core.hosting import Experiment, Hosting, RunsOn
from herringbone.core.instance import Instance
from herringbone.core.laws import Laws
from herringbone.core.outcome import EXIT_CODES, Outcome, OutcomeKind
from herringbone.core.variable import (
    Column,
    StateVector,
    Text,
    Variable,
    input_,
    local,
    output,
    parameter,
    state,
)

__all__ = [
    "EXIT_CODES",
    "Column",
    "Component",
    "Declaration",
    "EquilibriumError",
    "Experiment",
    "FmuError",
    "HerringboneError",
    "Hosting",
    "Instance",
    "Kernels",
    "Laws",
    "Outcome",
    "OutcomeKind",
    "ParameterError",
    "ResourceError",
    "RunsOn",
    "StateVector",
    "StructureError",
    "Text",
    "Variable",
    "input_",
    "local",
    "one_line",
    "output",
    "parameter",
    "reason",
    "state",
]

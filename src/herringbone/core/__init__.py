"""Declarations that everything else is derived from: variables, blocks, units, errors, outcomes."""

from herringbone.core.declaring.component import Beyond, Component, Kernels
from herringbone.core.declaring.declaration import Declaration
from herringbone.core.declaring.hosting import Experiment, Hosting, Remark, RunsOn
from herringbone.core.declaring.laws import Laws, common_period
from herringbone.core.declaring.variable import (
    Column,
    StateVector,
    Text,
    Variable,
    choice,
    input_,
    local,
    output,
    parameter,
    state,
)
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
from herringbone.core.instance import Instance
from herringbone.core.outcome import EXIT_CODES, Outcome, OutcomeKind

__all__ = [
    "EXIT_CODES",
    "Beyond",
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
    "Remark",
    "ResourceError",
    "RunsOn",
    "StateVector",
    "StructureError",
    "Text",
    "Variable",
    "choice",
    "common_period",
    "input_",
    "local",
    "one_line",
    "output",
    "parameter",
    "reason",
    "state",
]

"""Declarations that everything else is derived from: variables, blocks, units, errors, outcomes.

Names are loaded when they are used: who only needs an error needs no arrays.
"""

import importlib
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from herringbone.core.declaring.component import Beyond, Component, Kernels
    from herringbone.core.declaring.declaration import Declaration
    from herringbone.core.declaring.hosting import (
        Asked,
        ByTolerance,
        Experiment,
        Hosting,
        Remark,
        RunsOn,
    )
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
    "Asked",
    "Beyond",
    "ByTolerance",
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

_WHERE = {
    "Beyond": "herringbone.core.declaring.component",
    "Component": "herringbone.core.declaring.component",
    "Kernels": "herringbone.core.declaring.component",
    "Declaration": "herringbone.core.declaring.declaration",
    "Asked": "herringbone.core.declaring.hosting",
    "ByTolerance": "herringbone.core.declaring.hosting",
    "Experiment": "herringbone.core.declaring.hosting",
    "Hosting": "herringbone.core.declaring.hosting",
    "Remark": "herringbone.core.declaring.hosting",
    "RunsOn": "herringbone.core.declaring.hosting",
    "Laws": "herringbone.core.declaring.laws",
    "common_period": "herringbone.core.declaring.laws",
    "Column": "herringbone.core.declaring.variable",
    "StateVector": "herringbone.core.declaring.variable",
    "Text": "herringbone.core.declaring.variable",
    "Variable": "herringbone.core.declaring.variable",
    "choice": "herringbone.core.declaring.variable",
    "input_": "herringbone.core.declaring.variable",
    "local": "herringbone.core.declaring.variable",
    "output": "herringbone.core.declaring.variable",
    "parameter": "herringbone.core.declaring.variable",
    "state": "herringbone.core.declaring.variable",
    "EquilibriumError": "herringbone.core.errors",
    "FmuError": "herringbone.core.errors",
    "HerringboneError": "herringbone.core.errors",
    "ParameterError": "herringbone.core.errors",
    "ResourceError": "herringbone.core.errors",
    "StructureError": "herringbone.core.errors",
    "one_line": "herringbone.core.errors",
    "reason": "herringbone.core.errors",
    "Instance": "herringbone.core.instance",
    "EXIT_CODES": "herringbone.core.outcome",
    "Outcome": "herringbone.core.outcome",
    "OutcomeKind": "herringbone.core.outcome",
}

if not TYPE_CHECKING:  # type checkers take the names above, and know no others

    def __getattr__(name: str) -> object:
        if name in _WHERE:
            return getattr(importlib.import_module(_WHERE[name]), name)
        raise AttributeError(f"module 'herringbone.core' has no attribute '{name}'")

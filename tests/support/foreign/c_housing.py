"""The housing of `tests/fmus/c_housing.c`, right or wrong in one way."""

from itertools import product
from pathlib import Path

from herringbone.core.declaring.roles import HALVES
from support.foreign.fmi3_description import c_part

SOURCE = Path(__file__).parents[2] / "fmus" / "c_housing.c"
DOFS = list(product(HALVES, "xyz"))


def description(*, units=None, without=(), saves=False) -> str:
    """The modelDescription.xml; `units` replaces some by name, `without` leaves variables out."""
    states = ' canGetAndSetFMUstate="true"' if saves else ""
    kinds = (("f", "N", "input"), ("s", "m", "output"), ("v", "m/s", "output"))
    variables, outputs = [], []
    for group, (quantity, unit, causality) in enumerate(kinds):
        for i, (seat, axis) in enumerate(DOFS):
            name, reference = f"{seat}.{quantity}_{axis}", 12 * group + i
            if name in without:
                continue
            shown = (units or {}).get(name, unit)
            start = ' start="0"' if causality == "input" else ""
            variables.append(
                f'<ScalarVariable name="{name}" valueReference="{reference}" '
                f'causality="{causality}"><Real unit="{shown}"{start}/></ScalarVariable>'
            )
            if causality == "output":
                outputs.append(f'<Unknown index="{len(variables)}" dependencies=""/>')
    return f"""<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="2.0" modelName="c_housing" guid="c" numberOfEventIndicators="0">
<CoSimulation modelIdentifier="c_housing" canHandleVariableCommunicationStepSize="true"{states}/>
<UnitDefinitions>
<Unit name="N"><BaseUnit kg="1" m="1" s="-2"/></Unit>
<Unit name="m"><BaseUnit m="1"/></Unit>
<Unit name="m/s"><BaseUnit m="1" s="-1"/></Unit>
</UnitDefinitions>
<ModelVariables>{"".join(variables)}</ModelVariables>
<ModelStructure><Outputs>{"".join(outputs)}</Outputs>
<InitialUnknowns>{"".join(outputs)}</InitialUnknowns></ModelStructure>
</fmiModelDescription>
"""


def c_housing_fmu(
    folder: Path, defines: tuple[str, ...] = (), *, fmi: int = 2, **described
) -> Path:
    """The FMU with macros that are set, in a folder."""
    return c_part(SOURCE, description(**described), folder, defines, fmi=fmi)

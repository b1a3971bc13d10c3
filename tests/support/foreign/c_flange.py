"""Right and wrong parts with flanges, from `tests/fmus/c_flange.c`."""

from pathlib import Path

from support.foreign.fmi3_description import c_part

SOURCE = Path(__file__).parents[2] / "fmus" / "c_flange.c"
_UNITS = {"tau": "N.m", "drive": "N.m", "phi": "rad", "w": "rad/s"}
_COUPLED = {0: "a.phi", 1: "a.w", 2: "b.phi", 3: "b.w"}, {4: "a.tau", 5: "b.tau"}
_SHAFT = {0: "flange.phi", 1: "flange.w", 2: "drive"}, {4: "flange.tau"}
PORTS = {
    "ROTOR": ({0: "flange.tau", 1: "drive"}, {4: "flange.phi", 5: "flange.w"}),
    "SHAFT": _SHAFT,
    "SLIDER": _SHAFT,
    "COUPLING": _COUPLED,
    "HUB": _COUPLED,
    "BODIES": ({0: "a.tau", 1: "b.tau"}, {4: "a.phi", 5: "a.w", 6: "b.phi", 7: "b.w"}),
    "BAR": ({0: "a.tau", 1: "b.phi", 2: "b.w"}, {4: "a.phi", 5: "a.w", 6: "b.tau"}),
}
"""Inputs and outputs by value reference."""


def description(part, *, units=None, without=(), starts=None, saves=True) -> str:
    """The modelDescription.xml; `units`, `starts` by name, `without` leaves variables out."""
    variables, outputs = [], []
    for causality, names in zip(("input", "output"), PORTS[part], strict=True):
        for reference, name in names.items():
            if name in without:
                continue
            unit = (units or {}).get(name, _UNITS[name.rpartition(".")[2]])
            value = (starts or {}).get(name, 0)
            start = f' start="{value}"' if causality == "input" else ""
            variables.append(
                f'<ScalarVariable name="{name}" valueReference="{reference}" '
                f'causality="{causality}"><Real unit="{unit}"{start}/></ScalarVariable>'
            )
            if causality == "output":
                outputs.append(f'<Unknown index="{len(variables)}"/>')
    ability = ' canGetAndSetFMUstate="true"' if saves else ""
    return f"""<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="2.0" modelName="c_flange" guid="c">
<CoSimulation modelIdentifier="c_flange" canHandleVariableCommunicationStepSize="true"{ability}/>
<UnitDefinitions>
<Unit name="N.m"><BaseUnit kg="1" m="2" s="-2"/></Unit>
<Unit name="rad"><BaseUnit rad="1"/></Unit>
<Unit name="rad/s"><BaseUnit rad="1" s="-1"/></Unit>
<Unit name="1/min"><BaseUnit rad="1" s="-1" factor="0.10471975511965977"/></Unit>
<Unit name="m"><BaseUnit m="1"/></Unit>
</UnitDefinitions>
<ModelVariables>{"".join(variables)}</ModelVariables>
<ModelStructure><Outputs>{"".join(outputs)}</Outputs>
<InitialUnknowns>{"".join(outputs)}</InitialUnknowns></ModelStructure>
</fmiModelDescription>
"""


def c_flange(
    folder: Path, part: str, fault: str = "NONE", *more: str, fmi: int = 2, **described
) -> Path:
    """The FMU of a part with a fault, and more macros, in a folder of its own."""
    place = folder / f"{part}_{fault}".lower()
    place.mkdir()
    defines = (f"PART={part}", f"FAULT={fault}", *more)
    return c_part(SOURCE, description(part, **described), place, defines, fmi=fmi)

"""Two rotors on a spring-damper, all in C (`tests/fmus/drivetrain.c`), and their exact motion."""

from pathlib import Path

import numpy as np
from scipy.linalg import expm

import herringbone as hb
from support.foreign.c_fmu import compiled_fmu
from support.foreign.fmi3_description import as_fmi3
from support.foreign.strangers import write_system

SOURCE = Path(__file__).parents[2] / "fmus" / "drivetrain.c"
EVENTS = 'hasEventMode="true" mightReturnEarlyFromDoStep="true"'
WITHIN = 'providesIntermediateUpdate="true"'
JOINED = [
    ["motor.phi", "shaft.a.phi"], ["motor.w", "shaft.a.w"], ["shaft.a.tau", "motor.tau"],
    ["load.phi", "shaft.b.phi"], ["load.w", "shaft.b.w"], ["shaft.b.tau", "load.tau"],
]  # fmt: skip
VALUES = {
    "motor.inertia": 0.1, "motor.speed": 100.0, "motor.own": 50.0, "load.inertia": 0.3,
    "load.speed": 90.0, "shaft.stiffness": 2e4, "shaft.damping": 4.0,
}  # fmt: skip
"""SI units; 82 Hz, damped by 5 %."""
_VARIABLES = {
    "ROTOR": (("tau",), ("phi", "w", "events"), ("inertia", "speed", "own", "from")),
    "COUPLING": (
        ("a.phi", "a.w", "b.phi", "b.w"), ("a.tau", "b.tau"), ("stiffness", "damping"),
    ),
}  # fmt: skip
_UNITS = {"tau": "N.m", "phi": "rad", "w": "rad/s"}
_ATTRIBUTES = {
    "input": ('causality="input"', ' start="0"'),
    "output": ('causality="output"', ""),
    "parameter": ('causality="parameter" variability="fixed"', ' start="1"'),
}


def description(part: str, *, saves: bool, varies: bool = True) -> str:
    """modelDescription.xml of FMI 2.0; the outputs of a rotor depend on nothing."""
    kinds = zip(("input", "output", "parameter"), _VARIABLES[part], strict=True)
    rows = [(name, kind) for kind, names in kinds for name in names]
    variables = []
    for place, (name, kind) in enumerate(rows):
        unit = _UNITS.get(name.rpartition(".")[2])
        told, start = _ATTRIBUTES[kind]
        shown = f' unit="{unit}"' if unit else ""
        variables.append(
            f'<ScalarVariable name="{name}" valueReference="{place}" {told}><Real{shown}{start}/>'
            "</ScalarVariable>"
        )
    depends = ' dependencies=""' if part == "ROTOR" else ' dependencies="1 2 3 4"'
    places = [place for place, (_, kind) in enumerate(rows, 1) if kind == "output"]
    outputs = "".join(f'<Unknown index="{place}"{depends}/>' for place in places)
    state = ' canGetAndSetFMUstate="true"' if saves else ""
    if varies:
        state += ' canHandleVariableCommunicationStepSize="true"'
    return f"""<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="2.0" modelName="drivetrain" guid="t">
<CoSimulation modelIdentifier="drivetrain"{state}/>
<UnitDefinitions><Unit name="N.m"><BaseUnit kg="1" m="2" s="-2"/></Unit>
<Unit name="rad"><BaseUnit rad="1"/></Unit>
<Unit name="rad/s"><BaseUnit rad="1" s="-1"/></Unit></UnitDefinitions>
<ModelVariables>{"".join(variables)}</ModelVariables>
<ModelStructure><Outputs>{outputs}</Outputs></ModelStructure>
</fmiModelDescription>
"""


def drivetrain(
    folder: Path,
    fmi: int,
    abilities: str = "",
    *,
    saves: bool = True,
    steps: str = "",
    asks: bool = True,
) -> Path:
    """Folder of the system.

    Args:
        folder: to write into.
        fmi: version of all parts.
        abilities: of the rotors, such as EVENTS, of FMI 3.0.
        saves: parts save their states.
        steps: longest and shortest one that rotors take [s], two numbers; one length is told.
        asks: rotors that declare WITHIN ask for their torque within a step.
    """
    files = {}
    longest, shortest = steps.split() if steps else ("", "")
    more = ("FMI3",) if fmi > 2 else ()
    for part in ("ROTOR", "COUPLING"):
        place = folder / part.lower()
        place.mkdir(parents=True)
        one = steps != "" and longest == shortest and part == "ROTOR"
        told, defines = description(part, saves=saves, varies=not one), (f"PART={part}", *more)
        defines += (f"LONGEST={longest}", f"SHORTEST={shortest}") if steps else ()
        if fmi > 2:
            within = ("tau",) if WITHIN in abilities and part == "ROTOR" else ()
            told = as_fmi3(told, abilities if part == "ROTOR" else "", within)
            defines += ("WITHIN",) if within and asks else ()
        files[part] = compiled_fmu(SOURCE, told, place, defines)
    parts = {"motor": files["ROTOR"], "shaft": files["COUPLING"], "load": files["ROTOR"]}
    return write_system(folder, "system", JOINED, parts)


def turned(system: Path, step: float, begins: float, **options) -> hb.Result:
    """20 ms, while the motor's own torque is there from a time on [s]."""
    values = VALUES | {"motor.from": begins, "load.from": 1.0, "load.own": 0.0}
    return hb.run(
        system, values=values, start="rest", step=step, record_step=1e-3, t_end=0.02, **options
    )


def exact(time: np.ndarray, begins: float) -> np.ndarray:
    """(n, 4) phi and w of motor and load [rad], [rad/s]."""
    k, d = VALUES["shaft.stiffness"], VALUES["shaft.damping"]
    one, two = VALUES["motor.inertia"], VALUES["load.inertia"]
    a = np.zeros((5, 5))  # the last state is the motor's own torque
    a[0, 1] = a[2, 3] = 1.0
    a[1, :4] = np.array([-k, -d, k, d]) / one
    a[3, :4] = np.array([k, d, -k, -d]) / two
    a[1, 4] = 1.0 / one
    start = np.array([0.0, VALUES["motor.speed"], 0.0, VALUES["load.speed"], 0.0])
    at_event = expm(a * begins) @ start
    at_event[4] = VALUES["motor.own"]
    return np.array([
        (expm(a * t) @ start if t < begins else expm(a * (t - begins)) @ at_event)[:4] for t in time
    ])  # fmt: skip


def error(result: hb.Result, begins: float) -> float:
    """Largest error of the twist over its largest value: the shaft's torque but for damping."""
    found = result.data[["motor.phi", "load.phi"]].to_numpy()
    true = exact(result.data["time"].to_numpy(), begins)[:, [0, 2]]
    twist, wanted = found[:, 0] - found[:, 1], true[:, 0] - true[:, 1]
    return float(np.abs(twist - wanted).max() / np.abs(wanted).max())

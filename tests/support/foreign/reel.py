"""Two reels (`fmus/reel.py`, `fmus/reel.c`) with a spring between them: a system of strangers.

The number of steps of the one in Python is a state that nobody saves.
"""

import subprocess
import sys
import zipfile
from pathlib import Path

from support.foreign.c_fmu import compiled_fmu
from support.foreign.strangers import write_system

FMUS = Path(__file__).parents[2] / "fmus"
ABILITIES = ' canGetAndSetFMUstate="true" canSerializeFMUstate="true"'
JOINED = [
    ["left.s", "spring.x1"], ["left.v", "spring.v1"], ["spring.f1", "left.f"],
    ["right.s", "spring.x2"], ["right.v", "spring.v2"], ["spring.f2", "right.f"],
]  # fmt: skip


def description(name: str, inputs: str, outputs: str, more: str = "", *, saves: bool) -> str:
    """modelDescription.xml of a C source whose names stand in the order of its references."""
    rows = [(n, "input", ' start="0"') for n in inputs.split()]
    rows += [(n, "output", "") for n in outputs.split()]
    rows += [(n, 'parameter" variability="fixed', ' start="150"') for n in more.split()]
    variables = "".join(
        f'<ScalarVariable name="{n}" valueReference="{k}" causality="{c}"><Real{s}/>'
        "</ScalarVariable>"
        for k, (n, c, s) in enumerate(rows)
    )
    first = len(inputs.split()) + 1
    unknowns = "".join(f'<Unknown index="{first + k}"/>' for k in range(len(outputs.split())))
    states = ' canGetAndSetFMUstate="true"' if saves else ""
    return f"""<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="2.0" modelName="{name}" guid="{name}">
<CoSimulation modelIdentifier="{name}" canHandleVariableCommunicationStepSize="true"{states}/>
<ModelVariables>{variables}</ModelVariables>
<ModelStructure><Outputs>{unknowns}</Outputs>
<InitialUnknowns>{unknowns}</InitialUnknowns></ModelStructure>
</fmiModelDescription>
"""


def python_reel(folder: Path) -> Path:
    """The FMU in Python, which says that it saves and serialises its state."""
    command = [sys.executable, "-B", "-m", "pythonfmu", "build", "-f", str(FMUS / "reel.py")]
    subprocess.run(command, cwd=folder, check=True, capture_output=True)
    file = folder / "python_reel.fmu"
    with zipfile.ZipFile(folder / "Reel.fmu") as plain, zipfile.ZipFile(file, "w") as archive:
        for name in plain.namelist():
            content = plain.read(name)
            if name == "modelDescription.xml":
                content = _able(content.decode()).encode()
            archive.writestr(name, content)
    return file


def _able(text: str) -> str:
    for name in ("canGetAndSetFMUstate", "canSerializeFMUstate"):
        text = text.replace(f' {name}="false"', "").replace(f' {name}="true"', "")
    return text.replace("<CoSimulation", f"<CoSimulation{ABILITIES}", 1)


def reels(folder: Path, name: str = "reels", *, saves: bool = True) -> Path:
    """Folder of the system; saves: the parts in C save their states."""
    found = folder / name
    found.mkdir()
    right = compiled_fmu(
        FMUS / "reel.c", description("reel", "f", "s v", "holds", saves=saves), found
    )
    told = description("c_spring_damper", "x1 x2 v1 v2", "f1 f2", saves=saves)
    spring = compiled_fmu(FMUS / "kinds" / "translation" / "c_spring_damper.c", told, found)
    files = {"left": python_reel(found), "right": right, "spring": spring}
    return write_system(folder, name, JOINED, files)

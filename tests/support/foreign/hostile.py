"""The hostile FMU of `fmus/hostile.c`: its description, places and deeds."""

from enum import IntEnum
from pathlib import Path

from support.foreign.c_fmu import compiled_fmu

SOURCE = Path(__file__).parents[2] / "fmus" / "hostile.c"
_TWO = """<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="2.0" modelName="hostile" guid="h" numberOfEventIndicators="0">
<CoSimulation modelIdentifier="hostile" canHandleVariableCommunicationStepSize="true"/>
<ModelVariables>
<ScalarVariable name="place" valueReference="0" causality="parameter" variability="fixed">
<Real start="0"/></ScalarVariable>
<ScalarVariable name="deed" valueReference="1" causality="parameter" variability="fixed">
<Real start="0"/></ScalarVariable>
<ScalarVariable name="u" valueReference="2" causality="input"><Real start="0"/></ScalarVariable>
<ScalarVariable name="y" valueReference="3" causality="output"><Real/></ScalarVariable>
</ModelVariables>
<ModelStructure><Outputs><Unknown index="4" dependencies=""/></Outputs>
<InitialUnknowns><Unknown index="4" dependencies=""/></InitialUnknowns></ModelStructure>
</fmiModelDescription>
"""
_THREE = """<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="3.0" modelName="hostile" instantiationToken="h">
<CoSimulation modelIdentifier="hostile" canHandleVariableCommunicationStepSize="true"/>
<ModelVariables>
<Float64 name="place" valueReference="0" causality="parameter" variability="fixed" start="0"/>
<Float64 name="deed" valueReference="1" causality="parameter" variability="fixed" start="0"/>
<Float64 name="u" valueReference="2" causality="input" start="0"/>
<Float64 name="y" valueReference="3" causality="output"/>
</ModelVariables>
<ModelStructure><Output valueReference="3" dependencies=""/>
<InitialUnknown valueReference="3" dependencies=""/></ModelStructure>
</fmiModelDescription>
"""


class Place(IntEnum):
    """Where it happens; late ones after half of a run of 1 ms."""

    STEP = 1
    LATE_STEP = 2
    TERMINATE = 3
    FREE = 4
    INSTANTIATE = 5
    INITIALISE = 6
    SET = 7
    GET = 8


class Deed(IntEnum):
    """What happens."""

    EXIT = 1
    ABORT = 2
    MOVE = 3
    CRASH = 4
    SAY = 5
    OVERFLOW = 6
    LOOP = 7
    LEAVE = 8
    KILL = 9
    DIVIDE = 10
    TRAP = 11
    BUS = 12
    TWICE = 13
    STOP = 14
    SLEEP = 15
    TERM = 16
    DEADLOCK = 17
    FLOOD = 18
    UMASK = 19
    LOCALE = 20
    CLOSE = 21
    THREAD = 22
    ROUND = 23
    FLUSH = 24
    HANDLER = 25
    MASK = 26
    PRECISION = 27


ENDS = {
    Deed.EXIT: "exit code 0",
    Deed.LEAVE: "exit code 0",
    Deed.ABORT: "SIGABRT",
    Deed.CRASH: "SIGSEGV",
    Deed.OVERFLOW: "SIGSEGV",
    Deed.KILL: "SIGKILL",
    Deed.DIVIDE: "SIGFPE",
    Deed.TRAP: "SIG(ILL|TRAP)",
    Deed.BUS: "SIGBUS",
    Deed.TWICE: "SIGABRT",
    Deed.TERM: "SIGTERM",
    **dict.fromkeys((Deed.LOOP, Deed.STOP, Deed.SLEEP, Deed.DEADLOCK), "no answer"),
}
"""What is said of deeds that end a process, or stop it."""
SEEN = {
    Deed.MOVE: "the working folder",
    Deed.FLOOD: "bytes of output",
    Deed.UMASK: "the umask",
    Deed.LOCALE: "the locale",
    Deed.CLOSE: "open descriptors",
    Deed.THREAD: "the number of threads",
    Deed.ROUND: "the floating-point environment",
    Deed.FLUSH: "the floating-point environment",
    Deed.PRECISION: "the floating-point environment",
    Deed.HANDLER: "",
    Deed.MASK: "",
}
"""What is noticed of deeds that a cell holds."""


def hostile_fmu(folder: Path, fmi: int = 2) -> Path:
    """The FMU of an FMI version."""
    return compiled_fmu(SOURCE, _TWO if fmi == 2 else _THREE, folder, () if fmi == 2 else ("FMI3",))

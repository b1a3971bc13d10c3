"""Opening FMU files safely: what is checked before anything of a file is loaded."""

import io
import re
import zipfile
from pathlib import Path
from typing import Final
from xml.etree.ElementTree import Element, tostring

import fmpy
from fmpy.model_description import ModelDescription, read_model_description

from herringbone.core import FmuError
from herringbone.core.places.files import is_file, is_folder, not_utf8
from herringbone.core.places.temporary import filled_folder
from herringbone.core.reading.archives import open_archive
from herringbone.core.reading.numbers import number
from herringbone.core.reading.xml import LARGEST_XML, parse_xml

_DESCRIPTION = "modelDescription.xml"
_PYTHON = "resources/slavemodule.txt"
"""By which pythonfmu finds its class."""
_USABLE = re.compile(r"2\.0|3\.0(\.\d+)?")
_MOST_REFERENCE: Final = 2**32


def require_file(file: Path) -> None:
    """Check that there is a file; raises FmuError."""
    if is_folder(file):
        raise FmuError(f"{file} is a folder; give an .fmu file")
    if not is_file(file):
        raise FmuError(f"there is no file {file}")


def read_fmu(file: str | Path) -> ModelDescription:
    """Model description of an FMU 2.0 or 3.0 for co-simulation that runs on this platform.

    Raises:
        FmuError: no file, no zip, unsafe names or XML, another FMI version or kind, no binary for
            this platform, or a name on its way, or on that to the current folder, is not UTF-8.
    """
    file = Path(file)
    require_file(file)
    if name := not_utf8(file):  # FMUs are told their place as UTF-8
        raise FmuError(f"{file}: the name {name} is not UTF-8; rename it")
    with open_archive(file, "an FMU", FmuError) as archive:
        names = archive.names
        if _DESCRIPTION not in names:
            raise FmuError(f"{file} is not an FMU: it contains no {_DESCRIPTION}")
        description = archive.read(_DESCRIPTION, LARGEST_XML)
    root = parse_xml(description, f"{file}: {_DESCRIPTION}", FmuError)
    _check_version(root, file)
    try:
        model = read_model_description(_repacked(root), validate=False)
        _check_names(model)
        _check_numbers(model)
        _take_differences(model, root)
    except UnicodeEncodeError as error:  # libxml2 asks for the current folder
        raise FmuError(
            f"{file}: no FMU can be read from the current folder, as its name "
            f"{not_utf8(Path.cwd())} is not UTF-8; rename it, or cd to another"
        ) from error
    except Exception as error:  # fmpy raises bare Exception for every defect of the XML
        raise FmuError(
            f"{file}: {_DESCRIPTION} cannot be read: {error or type(error).__name__}"
        ) from error
    clocks = [v.name for v in model.modelVariables if v.type == "Clock"]
    if model.coSimulation is None:
        kinds = {"model exchange": model.modelExchange,
                 "scheduled execution": model.scheduledExecution}  # fmt: skip
        offered = " and ".join(kind for kind, found in kinds.items() if found) or "nothing"
        ticking = f", and has Clock variables: {', '.join(clocks)}" if clocks else ""
        raise FmuError(f"{file} is for {offered} only; co-simulation is needed{ticking}")
    if clocks:
        raise FmuError(f"{file} has Clock variables, which are not supported: {', '.join(clocks)}")
    library = f"{model.coSimulation.modelIdentifier}{fmpy.sharedLibraryExtension}"
    platform = fmpy.platform_tuple if is_fmi3(model) else fmpy.platform
    binary = f"binaries/{platform}/{library}"
    if binary not in names:
        parts = (name.split("/") for name in names)
        have = sorted({part[1] for part in parts if part[0] == "binaries" and any(part[1:2])})
        raise FmuError(
            f"{file} has no binary for this platform ({binary}); "
            f"it has: {', '.join(have) or 'none'}"
        )
    return model


def _check_version(root: Element, file: Path) -> None:
    version = root.get("fmiVersion", "unknown")
    if not _USABLE.fullmatch(version):
        raise FmuError(
            f"{file} is an FMI {version} unit; FMI 2.0 or 3.0 for co-simulation is needed"
        )


def _repacked(root: Element) -> io.BytesIO:
    """An archive of the description as it was parsed: fmpy reads with another parser."""
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w") as archive:
        archive.writestr(_DESCRIPTION, tostring(root, encoding="utf-8"))
    packed.seek(0)
    return packed


def _check_names(model: ModelDescription) -> None:
    """Each variable, and each alias of one, has a name; raises ValueError."""
    for variable in model.modelVariables:
        if not variable.name:
            raise ValueError(f"the variable of reference {variable.valueReference} has no name")


def _check_numbers(model: ModelDescription) -> None:
    """Numbers of the description that are used here; raises ValueError."""
    for variable in model.modelVariables:
        if not 0 <= variable.valueReference < _MOST_REFERENCE:
            raise ValueError(f"{variable.name} has the reference {variable.valueReference}")
    for unit in model.unitDefinitions:
        base = unit.baseUnit
        for value in (base.factor, base.offset) if base else ():
            number(str(value or 0))
    experiment = model.defaultExperiment
    times = (experiment.startTime, experiment.stopTime, experiment.stepSize) if experiment else ()
    inner = model.coSimulation.fixedInternalStepSize if model.coSimulation else None
    for text in (*times, inner):
        number(str(text or 0))


def _take_differences(model: ModelDescription, root: Element) -> None:
    """Note which variables are differences: fmpy asks elements for the attribute in vain."""
    told: dict[str | None, bool] = {}
    for variable in root.iterfind("ModelVariables/*"):
        for element in (variable, *variable):  # the kind of FMI 2.0, or aliases of 3.0
            if (word := element.get("relativeQuantity")) is not None:
                names = (variable.get("name"), *(a.get("name") for a in variable.iterfind("Alias")))
                told |= dict.fromkeys(names, word in {"true", "1"})
    for v in model.modelVariables:
        v.relativeQuantity = told.get(v.name)


def is_fmi3(model: ModelDescription) -> bool:
    """True for an FMU 3.0, False for an FMU 2.0."""
    return model.fmiVersion.startswith("3.")


def extract_fmu(file: Path) -> Path:
    """Extract a checked FMU to a new temporary folder, whose path Python FMUs can load from.

    Raises:
        FmuError: it is a Python FMU, and pythonfmu cannot decode the path of that folder.
    """
    with filled_folder() as folder, open_archive(file, "an FMU", FmuError) as archive:
        undecoded = "%" in folder.as_uri().replace("%20", "")  # it decodes spaces alone
        if undecoded and _PYTHON in archive.names:
            raise FmuError(
                f"temporary folder {folder} has characters that Python FMUs cannot load from; "
                "set TMPDIR to a path of ASCII letters, digits, _ . - ~ / and spaces"
            )
        archive.extract(folder)
    return folder

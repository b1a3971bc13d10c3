"""Opening FMU files safely: what is checked before anything of a file is loaded."""

import re
import tempfile
import zipfile
from pathlib import Path

import fmpy
from fmpy.model_description import ModelDescription, read_model_description

from herringbone.core import FmuError
from herringbone.core.files import is_file, is_folder
from herringbone.cosim.fmu.archive import escaping_entry

_DESCRIPTION = "modelDescription.xml"
_FOREIGN_XML = re.compile(rb"<!(DOCTYPE|ENTITY)", re.IGNORECASE)
_USABLE = re.compile(r"2\.0|3\.0(\.\d+)?")
_VERSION = re.compile(rb'fmiVersion\s*=\s*["\']([^"\']*)["\']')


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
            this platform.
    """
    file = Path(file)
    require_file(file)
    try:
        with zipfile.ZipFile(file) as archive:
            names = archive.namelist()
            if name := escaping_entry(names):
                raise FmuError(
                    f"{file}: entry '{name}' would be written outside its folder; refused"
                )
            description = archive.read(_DESCRIPTION)
    except zipfile.BadZipFile as error:
        raise FmuError(f"{file} is not an FMU: {error}") from error
    except KeyError:
        raise FmuError(f"{file} is not an FMU: it contains no {_DESCRIPTION}") from None
    _check_description(description, file)
    try:
        model = read_model_description(str(file), validate=False)
    except Exception as error:  # fmpy raises bare Exception for every defect of the XML
        raise FmuError(f"{file}: {_DESCRIPTION} cannot be read: {error}") from error
    if model.coSimulation is None:
        kinds = {"model exchange": model.modelExchange,
                 "scheduled execution": model.scheduledExecution}  # fmt: skip
        offered = " and ".join(kind for kind, found in kinds.items() if found) or "nothing"
        raise FmuError(f"{file} is for {offered} only; co-simulation is needed")
    if clocks := [v.name for v in model.modelVariables if v.type == "Clock"]:
        raise FmuError(f"{file} has Clock variables, which are not supported: {', '.join(clocks)}")
    library = f"{model.coSimulation.modelIdentifier}{fmpy.sharedLibraryExtension}"
    platform = fmpy.platform_tuple if is_fmi3(model) else fmpy.platform
    binary = f"binaries/{platform}/{library}"
    if binary not in names:
        have = sorted({n.split("/")[1] for n in names if n.startswith("binaries/") and n[9:]})
        raise FmuError(
            f"{file} has no binary for this platform ({binary}); "
            f"it has: {', '.join(have) or 'none'}"
        )
    return model


def _check_description(description: bytes, file: Path) -> None:
    if _FOREIGN_XML.search(description):
        raise FmuError(f"{file}: {_DESCRIPTION} declares a DOCTYPE or an entity; refused")
    found = _VERSION.search(description)
    version = found.group(1).decode("ascii", "replace") if found else "unknown"
    if not _USABLE.fullmatch(version):
        raise FmuError(
            f"{file} is an FMI {version} unit; FMI 2.0 or 3.0 for co-simulation is needed"
        )


def is_fmi3(model: ModelDescription) -> bool:
    """True for an FMU 3.0, False for an FMU 2.0."""
    return model.fmiVersion.startswith("3.")


def extract_fmu(file: Path) -> Path:
    """Extract a checked FMU to a new temporary folder, whose path Python FMUs can load from.

    Raises:
        FmuError: the folder for temporary files has a path that pythonfmu cannot decode.
    """
    folder = Path(tempfile.mkdtemp(prefix="herringbone_"))
    if not str(folder).isascii() or "#" in str(folder) or "%" in str(folder):
        folder.rmdir()
        raise FmuError(
            f"temporary folder {folder} has characters that Python FMUs cannot load from; "
            "set TMPDIR to a plain ASCII path"
        )
    fmpy.extract(str(file), unzipdir=str(folder))
    return folder

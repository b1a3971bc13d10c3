"""fmpy's validation of an FMU, without its parser for names that are plainly legal.

That parser takes milliseconds a name, seconds for the variables of a system.
"""

import re
import zipfile
from pathlib import Path

from fmpy.model_description import read_model_description

_PART = r"[A-Za-z_][A-Za-z_0-9]*(\[[0-9]+(,[0-9]+)*\])?"
_PATH = rf"{_PART}(\.{_PART})*"
_PLAIN = re.compile(rf"{_PATH}|der\({_PATH}(,[0-9]+)?\)")
"""Structured names (FMI 2.0.4, section 2.2.9), but those with quoted parts."""


def is_plain(name: str) -> bool:
    """True if a name is a legal structured one, without quoted parts."""
    return _PLAIN.fullmatch(name) is not None


def validation_problems(path: str | Path) -> list[str]:
    """Problems that `fmpy.validation.validate_fmu` finds, one line each.

    Args:
        path: the FMU.
    """
    file = str(path)
    if _is_sound(file):
        return []
    from fmpy.validation import validate_fmu  # noqa: PLC0415 (lazy)

    return list(validate_fmu(file))


def _is_sound(file: str) -> bool:
    """True if fmpy finds nothing, and names are plain; where that is not so, it is asked whole."""
    try:
        with zipfile.ZipFile(file) as archive:
            if any("\\" in item.orig_filename for item in archive.filelist):
                return False
        model = read_model_description(file, validate_model_structure=True)
    except Exception:  # fmpy raises bare Exception for every defect of the XML
        return False
    return all(is_plain(variable.name) for variable in model.modelVariables)

"""Which kind of FMU a run uses."""

from typing import Final, Literal, get_args

from herringbone.core import ParameterError
from herringbone.fmi.native import find_compiler, own_platform

FmuKind = Literal["native", "python", "in-process"]
AUTO: Final = "auto"
_KINDS: tuple[FmuKind, ...] = get_args(FmuKind)


def choose_kind(fmu: str) -> tuple[FmuKind, tuple[str, ...]]:
    """The kind that was asked for, or with "auto" the fastest FMUs that can be built here.

    Returns:
        The kind, and a note if something slower than native FMUs was chosen.

    Raises:
        ParameterError: there is no such kind.
    """
    for kind in _KINDS:
        if fmu == kind:
            return kind, ()
    if fmu != AUTO:
        kinds = ", ".join((AUTO, *_KINDS))
        raise ParameterError(f"fmu = {fmu!r}; it must be one of {kinds}")
    own = own_platform()
    if own and find_compiler(own):
        return "native", ()
    why = "no C compiler was found" if own else "there are none for this platform"
    remedy = ": install cc, or zig with 'pip install herringbone[native]'" if own else ""
    return "python", (f"Python FMUs instead of native ones, which are faster: {why}{remedy}",)

"""Resource files that the FMUs of an exported system carry."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

from herringbone.components.registry import component
from herringbone.core import ParameterError
from herringbone.core.wording import option
from herringbone.cosim.structure.system import PartSpec, System


def carried_files(part: PartSpec) -> dict[str, Path]:
    """Files that a part's FMU is to carry, by String parameter.

    Resources must lie in the FMU: a file of this machine is not there on another one.
    """
    texts = component(str(part.component)).declaration.texts
    given = {text.name: Path(str(part.values.get(text.name, text.start))) for text in texts}
    return {name: file for name, file in given.items() if file.is_absolute()}


def without_files(system: System, carried: Mapping[str, Mapping[str, Path]]) -> System:
    """The system without values that name files which FMUs carry."""
    parts = (
        replace(p, values={v: x for v, x in p.values.items() if v not in carried.get(p.name, ())})
        for p in system.parts
    )
    return replace(system, parts=tuple(parts))


def refuse_files(part: PartSpec) -> None:
    """Raise ParameterError if a Python FMU would need a file of this machine."""
    for name, file in carried_files(part).items():
        raise ParameterError(
            f"{part.name}.{name} = '{file}': an .ssp file must not depend on files outside it; "
            f"native FMUs carry it: leave out {option('python')}"
        )

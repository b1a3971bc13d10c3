"""Which inputs of an FMU 3.0 may be given within a step."""

from pathlib import Path

from fmpy.model_description import ModelDescription

from herringbone.core import FmuError
from herringbone.core.declaring.declaration import node_name
from herringbone.core.reading.xml import parse_xml

_DESCRIPTION = "modelDescription.xml"


def inputs_within(model: ModelDescription, folder: Path) -> list[int]:
    """Value references of real inputs with intermediate update; none if nodes stand for it.

    Args:
        model: as fmpy reads it, which passes over the variables' attribute.
        folder: where the FMU is extracted.

    Raises:
        FmuError: the description is none.
    """
    if not model.coSimulation.providesIntermediateUpdate:
        return []
    names = {v.name for v in model.modelVariables}
    file = folder / _DESCRIPTION
    root = parse_xml(file.read_bytes(), str(file), FmuError)
    found = [v for v in root.iterfind("ModelVariables/Float64") if v.get("causality") == "input"]
    if any(_has_nodes(str(v.get("name")), names) for v in found):
        return []
    return [
        int(str(v.get("valueReference")))
        for v in found
        if v.get("intermediateUpdate") in {"true", "1"}
    ]


def _has_nodes(name: str, names: set[str]) -> bool:
    """Whether values of an input within a step are a variable, one by one or as an array."""
    return node_name(name, 1) in names or f"{name}.node" in names

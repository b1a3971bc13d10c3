"""Writing a system as an SSP 1.0 file that other masters read.

What masters differ in is avoided: one flat system if nothing else is asked for, the customary
prefixes declared on the root element only, one parameter file per component with bare variable
names and the set name `PARAMETER_SET`. libcosim takes the step from the annotation in the default
experiment, OMSimulator from the one in the system. libcosim sets start values of states only from
its own format, which lies in the file as well (`osp_structure`).

Names of nested parts are flat in one system (see `core.places.part_path`); an annotation keeps
their paths.

Connectors are the connected variables and all outputs that this master would record; signal nodes
stay out, so that other masters hold inputs over a step.
"""

import re
import zipfile
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import cast
from xml.etree.ElementTree import Element, SubElement, indent, tostring

from herringbone.core import StructureError
from herringbone.core.part import Part
from herringbone.core.places.files import replacing
from herringbone.cosim.ssp.described import DescribedPart
from herringbone.cosim.ssp.format import STRUCTURE_FILE
from herringbone.cosim.ssp.osp_structure import OSP_FILE, osp_structure
from herringbone.cosim.ssp.structure import structure, xml_root
from herringbone.cosim.structure.network import build_network
from herringbone.cosim.structure.system import PartSpec, System

PARAMETER_SET = "start"
"""Name of the parameter set of every component; ecos wants it in `init(parameter_set=...)`."""
_TIMESTAMP = (1980, 1, 1, 0, 0, 0)
_PERMISSIONS = 0o644 << 16
_PLAIN = re.compile(r"[A-Za-z0-9._-]+", re.ASCII)
"""Names of files that are the same in a URI."""


def write_ssp(
    system: System,
    fmus: Mapping[str, Path],
    file: str | Path,
    *,
    step: float,
    t_end: float,
    nested: bool = False,
) -> None:
    """Write a system with its FMUs and start values; the same input gives the same bytes.

    Args:
        system: structure, with all values that are to be set.
        fmus: FMU by part, or by component for parts that share it; parts that are FMU files need
            none.
        file: the .ssp file.
        step: communication step size [s].
        t_end: stop time of the default experiment [s].
        nested: nested systems stay so, see `ssp.boxes`; else one flat system.

    Raises:
        FmuError: an FMU cannot be read.
        StructureError: the connections are wrong, or a unit name has two meanings.
        ParameterError: a value does not belong to a variable, or its type has no place in SSP 1.0.
    """
    parts = [
        DescribedPart(spec.name, spec.fmu or _fmu(fmus, spec), spec.values) for spec in system.parts
    ]
    network = build_network(system, cast("list[Part]", parts))
    sources = _resource_names(parts)
    entries = {source: part.read_bytes() for part, source in sources.items()}
    entries |= {p.values_file: parameter_set(p.typed_values()) for p in parts if p.values}
    entries[OSP_FILE] = _text(osp_structure(parts, network, sources, step))
    whole = structure(system, parts, network, sources, step, t_end, nested=nested)
    entries[STRUCTURE_FILE] = _text(whole)
    _write_zip(entries, Path(file))


def _fmu(fmus: Mapping[str, Path], spec: PartSpec) -> Path:
    """The FMU of a part."""
    return fmus[spec.name] if spec.name in fmus else fmus[str(spec.component)]


def _resource_names(parts: Sequence[DescribedPart]) -> dict[Path, str]:
    """Place of each FMU file in the .ssp; instances of one file share it.

    Sources are URIs, in which '#', '?' and '%' mean something: a file whose name is not plain is
    called as the first part that uses it.
    """
    labels = [part.label for part in parts]
    if twice := [label for label in labels if labels.count(label) > 1]:
        raise StructureError(f"two parts are called {twice[0]} in a flat file; rename one")
    names: dict[Path, str] = {}
    for part in parts:
        if part.file not in names:
            name, own = f"resources/{part.file.name}", f"resources/{part.label}.fmu"
            taken = name in names.values() or not _PLAIN.fullmatch(part.file.name)
            names[part.file] = own if taken else name
    if len(set(names.values())) < len(names):
        raise StructureError("two FMU files want the same name; rename one of them")
    return names


def parameter_set(values: Iterable[tuple[str, str, str]]) -> bytes:
    """A parameter file; of each value name, FMI 2.0 type and text."""
    root = xml_root("ssv:ParameterSet", ("ssv", "ssc"), name=PARAMETER_SET)
    parameters = SubElement(root, "ssv:Parameters")
    for name, kind, text in values:
        parameter = SubElement(parameters, "ssv:Parameter", name=name)
        SubElement(parameter, f"ssv:{kind}", value=text)
    return _text(root)


def _text(root: Element) -> bytes:
    indent(root)
    return tostring(root, encoding="UTF-8", xml_declaration=True) + b"\n"


def _write_zip(entries: Mapping[str, bytes], file: Path) -> None:
    """Stored, not compressed: FMUs are compressed, and the bytes do not depend on a zlib."""
    with replacing(file, text=False) as stream, zipfile.ZipFile(stream, "w") as archive:
        for name in sorted(entries):
            entry = zipfile.ZipInfo(name, _TIMESTAMP)
            entry.create_system = 3
            entry.external_attr = _PERMISSIONS
            archive.writestr(entry, entries[name], zipfile.ZIP_STORED)

"""Plans for jacobi.c: a system of this package, to be stepped by a master in C."""

import struct
import zipfile
from urllib.parse import quote

import numpy as np

from herringbone.cosim.ssp.described import DescribedPart
from herringbone.cosim.structure.network import build_network


def to_bits(value):
    return struct.pack(">d", float(value)).hex()


def read_rows(text):
    """Values that jacobi.c printed."""
    rows = [line.split() for line in text.splitlines()]
    return np.array([[struct.unpack(">d", bytes.fromhex(w))[0] for w in row] for row in rows])


def write_plan(system, fmus, platform, drive, names, grid, folder):
    """Unpack the FMUs of a system and write the plan of a run; returns the file.

    Args:
        system: the system, with all start values.
        fmus: FMU by component.
        platform: whose binaries are loaded.
        drive: what stands before an absolute path on that platform.
        names: results `instance.variable` that are recorded.
        grid: step size [s], macro steps, macro steps per record.
        folder: where the FMUs are unpacked.
    """
    parts = [DescribedPart(p.name, fmus[str(p.component)], p.values) for p in system.parts]
    network = build_network(system, parts)
    index = {part.name: i for i, part in enumerate(parts)}

    def place(part, variable):
        return f"{part} {parts[part].variables[variable].reference}"

    lines = []
    for i, part in enumerate(parts):
        unpacked = folder / part.file.stem
        with zipfile.ZipFile(part.file) as archive:
            archive.extractall(unpacked)
        name = part.model.coSimulation.modelIdentifier
        library = unpacked / "binaries" / platform.folder / f"{name}.{platform.extension}"
        resources = quote(f"{drive}{unpacked / 'resources'}".lstrip("/"), safe="/:")
        lines.append(f"part {part.name} {drive}{library} file:///{resources} {part.model.guid}")
        for variable, kind, text in part.typed_values():
            word, value = ("real", to_bits(text)) if kind == "Real" else ("text", text)
            lines.append(f"{word} {place(i, variable)} {value}")
    for c in network.connections:
        lines.append(f"connect {place(c.source, c.output)} {place(c.target, c.input)}")
    for name in names:
        instance, variable = system.split(name)
        lines.append(f"record {place(index[instance], variable)}")
    step, count, every = grid
    lines.append(f"run {to_bits(step)} {count} {every}")
    file = folder / "plan.txt"
    file.write_text("\n".join(lines) + "\n")
    return file

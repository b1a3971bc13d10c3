"""Start and size of the native FMUs of all components, and of whole systems."""

import statistics
import tempfile
import zipfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from herringbone.fmi.host import Host
from herringbone.fmi.native import PLATFORMS, build_native_fmus, find_compiler
from herringbone.running.exporting.system_fmu import export_fmu

SYSTEMS = ("gearbox", "test_rig")
_DATA = "resources/", "documentation/", "extra/"


@dataclass(frozen=True)
class NativeFmu:
    """A native FMU that was measured.

    Attributes:
        name: component or system.
        start_seconds: to instantiate and initialise, the median of the repeats.
        bytes: size of the packed file without its resources, documentation and reference results.
        platforms: for which it has a binary.
    """

    name: str
    start_seconds: float
    bytes: int
    platforms: tuple[str, ...]


def measure(repeats: int = 20) -> list[NativeFmu]:
    """Start and size of native FMUs with all platforms that can be built here.

    Raises:
        HerringboneError: native FMUs cannot be built, or one does not initialise.
    """
    platforms = tuple(name for name, platform in PLATFORMS.items() if find_compiler(platform))
    with tempfile.TemporaryDirectory() as folder:
        fmus = build_native_fmus(platforms=platforms)
        for system in SYSTEMS:
            file = Path(folder) / f"{system}.fmu"
            fmus[system] = export_fmu(system, file, platforms=platforms)
        return [
            NativeFmu(name, _start_seconds(name, file, repeats), _size(file), platforms)
            for name, file in fmus.items()
        ]


def _start_seconds(name: str, file: Path, repeats: int) -> float:
    with Host(name, file) as host:
        return statistics.median(host.start_seconds() for _ in range(repeats))


def _size(file: Path) -> int:
    """Packed size [bytes] without resources, documentation and reference results."""
    with zipfile.ZipFile(file) as archive:
        entries: Sequence[zipfile.ZipInfo] = archive.infolist()
    data = sum(e.compress_size for e in entries if e.filename.startswith(_DATA))
    return file.stat().st_size - data

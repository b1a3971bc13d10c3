"""What a run depends on, as digests: two runs with the same ones have the same rows."""

import hashlib
import platform
import sys
from dataclasses import replace
from functools import cache
from importlib.metadata import version
from pathlib import Path

from herringbone.core.caching.keys import digest_of, packed_key
from herringbone.core.files import is_file
from herringbone.cosim.structure.system import System
from herringbone.scenes import Scene

_BLOCK = 1 << 20
_LIBRARIES = "numpy", "numba", "scipy", "fmpy"


def settings_of(system: System, scene: Scene, options: object) -> dict[str, str]:
    """Digests by what they are of, as messages call it.

    Args:
        system: with all values.
        scene: of the run.
        options: what else is asked for; its text tells it.
    """
    plain = replace(scene, description="", gears={}, housings={}, values={})
    structure = (system.connections, sorted(system.channels.items()))
    parts = [f"{p.name} {p.component} {p.fmu and _content(p.fmu)}" for p in system.parts]
    values = [
        f"{p.name}.{name} {_told(value)}"
        for p in system.parts
        for name, value in sorted(p.values.items())
    ]
    scene_told = (plain.name, plain.t_end, plain.record_step, plain.start, plain.start_offset)
    return {
        "system": digest_of(system.name, repr(structure)),
        "parts and FMUs": digest_of(*parts),
        "values": digest_of(*values),
        "scene": digest_of(repr(scene_told)),
        "options": digest_of(repr(options)),
        "versions": _versions(),
    }


def key_of(settings: dict[str, str]) -> str:
    """One digest of all settings."""
    return digest_of(*(f"{name} {digest}" for name, digest in sorted(settings.items())))


def _told(value: object) -> str:
    """A value; the content of a file in place of its name."""
    if isinstance(value, str) and value and is_file(Path(value)):
        return _content(Path(value))
    return repr(value)


def _content(file: Path) -> str:
    """Digest of a file's content."""
    digest = hashlib.sha256()
    try:
        with file.open("rb") as stream:
            while block := stream.read(_BLOCK):
                digest.update(block)
    except OSError:  # whoever needs it says so
        return "not readable"
    return digest.hexdigest()


@cache
def _versions() -> str:
    """Of what computes: this package, Python, numerical libraries, the kind of processor."""
    libraries = (version(name) for name in _LIBRARIES)
    return digest_of(packed_key(), sys.version, platform.machine(), *libraries)

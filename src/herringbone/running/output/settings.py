"""What a run depends on, as digests: two runs with the same ones have the same rows."""

import platform
import sys
from dataclasses import replace
from functools import cache

from herringbone.core.caching.keys import digest_of, packed_key, versions_of
from herringbone.cosim.structure.system import System
from herringbone.running.content import digest_of_file, values_of
from herringbone.scenes import Scene

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
    parts = [f"{p.name} {p.component} {p.fmu and digest_of_file(p.fmu)}" for p in system.parts]
    values = [f"{p.name}.{told}" for p in system.parts for told in values_of(p.values)]
    values += [f"{p.name} {p.approach!r}" for p in system.parts if p.approach]
    told = (plain.name, plain.t_end, plain.record_step, plain.start, plain.start_offset)
    scene_told = (*told, plain.model) if plain.model else told
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


@cache
def _versions() -> str:
    """Of what computes: this package, Python, numerical libraries, the kind of processor."""
    machine = sys.version, platform.machine()
    return digest_of(packed_key(), *machine, *versions_of(*_LIBRARIES))

"""Cost of a macro step of the test rig: this master against others, on the same native FMUs.

One micro step per macro step, Jacobi with held inputs and all parts in parallel, which is what the
other masters do. Recording included: this master and the others keep all outputs of every step, as
they offer it (libcosim: time series in memory, ecos: CSV file), the plain loop the connected ones.
"""

import statistics
import tempfile
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

from herringbone.analysis.stability.limits import fastest_bond
from herringbone.benchmarks.other_masters import PACKAGES, macro_step
from herringbone.core.part import Part
from herringbone.core.places.part_path import flat_name
from herringbone.cosim.fmu.fmi2_part import Fmu2Part
from herringbone.cosim.layouts.layout import connected_outputs, record_names
from herringbone.cosim.simulation import make_grid, ready, simulate
from herringbone.cosim.ssp.write import write_ssp
from herringbone.cosim.structure.network import build_network
from herringbone.cosim.structure.system import System
from herringbone.fmi.native import build_native_fmus
from herringbone.running.exporting.parallel_step import PARALLEL
from herringbone.running.foreign.foreign_parts import understood
from herringbone.running.loading import instances, open_parts
from herringbone.running.prepared import Wishes, prepared

STEP = 2.5e-6
"""The gear mesh's micro step [s]."""
_SLOW = 4
"""Loops that are run through Python do this fraction of the steps."""
OURS = "this master, native FMUs"


@dataclass(frozen=True)
class MacroStep:
    """Time of a macro step [s] by loop, the median of the repeats; None: not installed.

    Attributes:
        loops: by name; the first one is this master with native FMUs.
        kernels: doStep of all parts alone: nothing set, read or recorded.
    """

    loops: Mapping[str, float | None]
    kernels: float


def measure(steps: int = 20000, repeats: int = 5, wishes: Wishes | None = None) -> MacroStep:
    """Measure all loops, one after another, repeatedly.

    Args:
        steps: macro steps of each measurement.
        repeats: measurements of each loop.
        wishes: other parts and values of the rig; with foreign FMUs only this master is measured.

    Raises:
        HerringboneError: native FMUs cannot be built, or another master fails.
    """
    system = prepared("test_rig", "loaded", wishes or Wishes(start_offset={})).system
    components = sorted({str(p.component) for p in system.parts if not p.foreign})
    with tempfile.TemporaryDirectory() as scratch:
        file = Path(scratch) / "test_rig.ssp"
        native = build_native_fmus(components)
        loops: dict[str, Callable[[], float | None]] = {
            OURS: lambda: _ours(system, "native", steps),
            "this master, in-process": lambda: _ours(system, "in-process", steps),
            "this master, Python FMUs": lambda: _ours(system, "python", steps // _SLOW),
        }
        if not system.foreign_parts:
            write_ssp(system, native, file, step=STEP, t_end=steps * STEP)
            loops["plain fmpy loop"] = lambda: _fmpy(system, steps // _SLOW)
            loops |= _others(system, file, steps // _SLOW)
        kernels = lambda: _ours(replace(system, connections=()), "native", steps, steps)  # noqa: E731
        found = {name: [measure_() for _ in range(repeats)] for name, measure_ in loops.items()}
        alone = [kernels() for _ in range(repeats)]
    medians = {
        n: None if None in v else statistics.median(t for t in v if t is not None)
        for n, v in found.items()
    }
    return MacroStep(medians, statistics.median(alone))


def _others(system: System, file: Path, steps: int) -> dict[str, Callable[[], float | None]]:
    """Other masters, with the outputs that this one records, and with none."""
    parts = open_parts(system, "in-process")
    outputs = record_names(build_network(system, parts))
    labels = map(flat_name, system.paths)
    names = [f"{label}.{n}" for label, ns in zip(labels, outputs, strict=True) for n in ns]
    return {
        name + ("" if recorded else ", nothing recorded"): partial(
            macro_step, name, file, STEP, steps, recorded
        )
        for name in PACKAGES
        for recorded in (names, ())
    }


def _ours(system: System, fmu: str, steps: int, every: int = 1) -> float:
    """Time of a macro step [s] as `run` has it; records every so many steps."""
    bond = fastest_bond(system) if system.connections else None
    parts = open_parts(system, fmu)
    if system.connections:
        parts, _ = understood(system, parts, instances, STEP)
    try:
        grid = make_grid(steps * STEP, STEP, every * STEP)
        found = simulate(system, parts, PARALLEL, grid, bond_frequency=bond)
        return found.wall_seconds / steps
    finally:
        for part in parts:
            part.close()


def _fmpy(system: System, steps: int) -> float:
    """As one would write it with fmpy: setReal, doStep, getReal of all parts."""
    parts = open_parts(system, "native")
    try:
        return plain_loop(system, parts, steps)
    finally:
        for part in parts:
            part.close()


def plain_loop(system: System, parts: list[Part], steps: int) -> float:
    """Initialise FMUs, and take so many macro steps; time of one [s]."""
    ready(system, parts, PARALLEL, make_grid(steps * STEP, STEP, STEP))
    network = build_network(system, parts)
    slaves = [part.slave for part in parts if isinstance(part, Fmu2Part)]
    wires = [network.inputs(p) for p in range(len(parts))]
    feeds = [[(c.source, c.output) for c in wire] for wire in wires]
    ins = [[parts[c.target].variables[c.input].reference for c in wire] for wire in wires]
    names = connected_outputs(network)
    outs = [[parts[p].variables[n].reference for n in names[p]] for p in range(len(parts))]
    values = [dict(zip(n, parts[p].get(n), strict=True)) for p, n in enumerate(names)]
    record = []
    begin = time.perf_counter()
    for n in range(steps):
        for p, slave in enumerate(slaves):
            slave.setReal(ins[p], [values[s][name] for s, name in feeds[p]])
        for slave in slaves:
            slave.doStep(n * STEP, STEP)
        for p, slave in enumerate(slaves):
            values[p] = dict(zip(names[p], slave.getReal(outs[p]), strict=True))
        record.append(list(values))
    return (time.perf_counter() - begin) / steps

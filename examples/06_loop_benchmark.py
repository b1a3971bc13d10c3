"""Benchmark: the compiled loop against a plain fmpy loop (Jacobi order 0), same Python FMUs."""

import time

from herringbone.api import load_scene, load_system, open_parts
from herringbone.core.part import Part
from herringbone.cosim.algorithms import Jacobi
from herringbone.cosim.network import build_network
from herringbone.cosim.plan import connected_outputs
from herringbone.cosim.simulation import make_grid, simulate
from herringbone.cosim.system import System
from herringbone.start import started

STEP = 2e-6


def compiled_loop(system: System, parts: list[Part], steps: int) -> float:
    """Time of a macro step [s]."""
    return simulate(system, parts, Jacobi(0), make_grid(steps * STEP, STEP, 1)).wall_seconds / steps


def fmpy_loop(system: System, parts: list[Part], steps: int) -> float:
    """As one would write it with fmpy: setReal, doStep, getReal; time of a macro step [s]."""
    compiled_loop(system, parts, 1)
    network, slaves = build_network(system, parts), [part.slave for part in parts]
    wires = [network.inputs(p) for p in range(len(parts))]
    feeds = [[(c.source, c.output) for c in wire] for wire in wires]
    ins = [[parts[c.target].variables[c.input].reference for c in wire] for wire in wires]
    names = connected_outputs(network)
    outs = [[parts[p].variables[n].reference for n in names[p]] for p in range(len(parts))]
    values = [dict(zip(n, parts[p].get(n), strict=True)) for p, n in enumerate(names)]
    stages = (network.sources, network.bodies, *([e] for e in network.elements))
    begin = time.perf_counter()
    for n, stage in ((n, stage) for n in range(1, steps) for stage in stages):
        for p in stage:
            slaves[p].setReal(ins[p], [values[s][name] for s, name in feeds[p]])
            slaves[p].doStep(n * STEP, STEP)
        for p in stage:
            values[p] = dict(zip(names[p], slaves[p].getReal(outs[p]), strict=True))
    return (time.perf_counter() - begin) / (steps - 1)


def main(steps: int = 2000) -> float:
    """Time of the fmpy loop over that of the compiled loop; 0 if they differ in a bit."""
    structure, folder = load_system("test_rig")
    system, _ = started(structure, load_scene(folder, "loaded"))
    seconds, last = {compiled_loop: [], fmpy_loop: []}, {}
    for _ in range(3):  # the best of three each
        for loop, found in seconds.items():
            parts = open_parts(system, "python")
            found.append(loop(system, parts, steps))
            last[loop] = parts[6].get(["shaft.pinion_left.f_y", "shaft.wheel_right.f_z"])
            [part.close() for part in parts]
    print({loop.__name__: f"{1e6 * min(found):.1f} us" for loop, found in seconds.items()})
    same = last[compiled_loop] == last[fmpy_loop]
    return min(seconds[fmpy_loop]) / min(seconds[compiled_loop]) if same else 0.0


if __name__ == "__main__":
    print(f"ratio {main():.2f}")

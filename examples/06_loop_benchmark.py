"""Benchmark: the compiled loop against a plain fmpy loop (Jacobi order 0), same Python FMUs."""

import time

from herringbone.api import load_scene, load_system, open_parts
from herringbone.core.part import Part
from herringbone.cosim.algorithms import Jacobi
from herringbone.cosim.network import build_network
from herringbone.cosim.simulation import make_grid, simulate
from herringbone.cosim.system import System
from herringbone.start import started

STEP = 2e-6


def compiled_loop(system: System, parts: list[Part], steps: int) -> float:
    """Time of a macro step [s]."""
    grid = make_grid(steps * STEP, STEP, 1.0)
    return simulate(system, parts, Jacobi(order=0), grid).wall_seconds / steps


def fmpy_loop(system: System, parts: list[Part], steps: int) -> float:
    """As one would write it with fmpy: setReal, doStep, getReal; time of a macro step [s]."""
    compiled_loop(system, parts, 1)
    network, slaves = build_network(system, parts), [part.slave for part in parts]
    feeds = [[(c.source, c.output) for c in network.inputs(p)] for p in range(len(parts))]
    ins = [[parts[c.target].variables[c.input].reference for c in network.inputs(p)]
           for p in range(len(parts))]  # fmt: skip
    names = [sorted({c.output for c in network.connections if c.source == p})
             for p in range(len(parts))]  # fmt: skip
    outs = [[parts[p].variables[n].reference for n in names[p]] for p in range(len(parts))]
    values = [dict(zip(n, parts[p].get(n), strict=True)) for p, n in enumerate(names)]
    begin = time.perf_counter()
    for n in range(1, steps):
        for stage in (network.sources, network.bodies, *([e] for e in network.elements)):
            for p in stage:
                slaves[p].setReal(ins[p], [values[s][name] for s, name in feeds[p]])
            for p in stage:
                slaves[p].doStep(n * STEP, STEP)
            for p in stage:
                values[p] = dict(zip(names[p], slaves[p].getReal(outs[p]), strict=True))
    return (time.perf_counter() - begin) / (steps - 1)


def main(steps: int = 2000) -> float:
    """Returns time of the fmpy loop over time of the compiled loop, best of three each."""
    system, folder = load_system("test_rig")
    system, _ = started(system, load_scene(folder, "loaded"))
    seconds, last = {compiled_loop: [], fmpy_loop: []}, {}
    for _ in range(3):
        for loop, found in seconds.items():
            parts = open_parts(system, "python")
            found.append(loop(system, parts, steps))
            last[loop] = parts[6].get(["shaft.pinion_left.f_y", "shaft.wheel_right.f_z"])
            [part.close() for part in parts]
    fast, plain = (1e6 * min(found) for found in seconds.values())
    same = last[compiled_loop] == last[fmpy_loop]
    print(f"compiled {fast:.1f} us, fmpy {plain:.1f} us a step, bit-identical: {same}")
    return plain / fast if same else 0.0


if __name__ == "__main__":
    print(f"ratio {main():.2f}")

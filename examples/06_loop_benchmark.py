"""Benchmark: the compiled loop against a plain fmpy loop, on the same Python FMUs.

Both run Jacobi order 0: sources, bodies, then elements with the bodies' new motions. The ratio is
what counts; both loops run alternately in this process.
"""

import time

import numpy as np

from herringbone.api import load_scene, load_system, open_parts
from herringbone.core.part import Part
from herringbone.cosim.algorithms import Jacobi
from herringbone.cosim.network import build_network
from herringbone.cosim.plan import record_names
from herringbone.cosim.simulation import make_grid, simulate
from herringbone.cosim.system import System
from herringbone.start import started

STEP = 2e-6


def fmpy_loop(system: System, parts: list[Part], steps: int) -> tuple[np.ndarray, float]:
    """As one would write it with fmpy: setReal, doStep, getReal; last outputs and time [s]."""
    network = build_network(system, parts)
    simulate(system, parts, Jacobi(order=0), make_grid(STEP, STEP, STEP))
    slaves = [part.slave for part in parts]
    feeds = [[(c.source, c.output) for c in network.inputs(p)] for p in range(len(parts))]
    targets = [[parts[p].variables[c.input].reference for c in network.inputs(p)]
               for p in range(len(parts))]  # fmt: skip
    names = [sorted({c.output for c in network.connections if c.source == p})
             for p in range(len(parts))]  # fmt: skip
    references = [[parts[p].variables[n].reference for n in names[p]] for p in range(len(parts))]
    values = [dict(zip(names[p], slaves[p].getReal(references[p]), strict=True))
              for p in range(len(parts))]  # fmt: skip
    begin = time.perf_counter()
    for n in range(1, steps):
        for stage in (network.sources, network.bodies, *([e] for e in network.elements)):
            for p in stage:
                if feeds[p]:
                    slaves[p].setReal(targets[p], [values[s][name] for s, name in feeds[p]])
            for p in stage:
                slaves[p].doStep(n * STEP, STEP)
            for p in stage:
                values[p] = dict(zip(names[p], slaves[p].getReal(references[p]), strict=True))
    seconds = time.perf_counter() - begin
    outputs = record_names(network)
    return np.concatenate([part.get(o) for part, o in zip(parts, outputs, strict=True)]), seconds


def main(steps: int = 2000) -> float:
    """Returns time of the plain loop over time of the compiled loop, best of three each."""
    structure, folder = load_system("test_rig")
    system, _ = started(structure, load_scene(folder, "loaded"))
    compiled, plain = [], []
    for _ in range(3):
        for seconds in (compiled, plain):
            parts = open_parts(system, "python")
            if seconds is compiled:
                grid = make_grid(steps * STEP, STEP, steps * STEP)
                recording = simulate(system, parts, Jacobi(order=0), grid)
                seconds.append(recording.wall_seconds / steps)
            else:
                last, total = fmpy_loop(system, parts, steps)
                seconds.append(total / (steps - 1))
            for part in parts:
                part.close()
    same = np.array_equal(last, recording.values[-1])
    print(f"compiled loop {1e6 * min(compiled):.1f} us, fmpy loop {1e6 * min(plain):.1f} us a step, "
          f"last outputs bit-identical: {same}")  # fmt: skip
    if not same:
        raise AssertionError("the two loops differ")
    return min(plain) / min(compiled)


if __name__ == "__main__":
    print(f"ratio {main():.2f}")

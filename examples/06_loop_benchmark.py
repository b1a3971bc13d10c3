"""Benchmark: the compiled loop against a plain fmpy loop, same Python FMUs, same results.

`herringbone bench macro-step` compares native FMUs and other masters.
"""

from herringbone.benchmarks.macro_step import PARALLEL, STEP, plain_loop
from herringbone.core.part import Part
from herringbone.cosim.simulation import make_grid, simulate
from herringbone.cosim.structure.system import System
from herringbone.running.loading import load_scene, load_system, open_parts
from herringbone.running.start import started

BEARINGS = "gearbox.bearing_supports"
FORCES = ["shaft.pinion_left.f_y", "shaft.wheel_right.f_z"]


def compiled_loop(system: System, parts: list[Part], steps: int) -> float:
    """Time of a macro step [s]."""
    grid = make_grid(steps * STEP, STEP, STEP)
    return simulate(system, parts, PARALLEL, grid).wall_seconds / steps


def fmpy_loop(system: System, parts: list[Part], steps: int) -> float:
    """As one would write it with fmpy: setReal, doStep, getReal; time of a macro step [s]."""
    return plain_loop(system, parts, steps)


def main(steps: int = 2000) -> float:
    """Time of the fmpy loop over that of the compiled loop; 0 if they differ in a bit."""
    structure, folder = load_system("test_rig")
    system, _ = started(structure, load_scene(folder, "loaded"))
    seconds, last = {compiled_loop: [], fmpy_loop: []}, {}
    for _ in range(3):  # the best of three each
        for loop, found in seconds.items():
            parts = open_parts(system, "python")
            found.append(loop(system, parts, steps))
            last[loop] = next(p for p in parts if p.name == BEARINGS).get(FORCES)
            [part.close() for part in parts]
    print({loop.__name__: f"{1e6 * min(found):.1f} us" for loop, found in seconds.items()})
    same = last[compiled_loop] == last[fmpy_loop]
    return min(seconds[fmpy_loop]) / min(seconds[compiled_loop]) if same else 0.0


if __name__ == "__main__":
    print(f"ratio {main():.2f}")

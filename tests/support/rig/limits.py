"""Predicted limits of the test rig under load and of random variants, found once a process."""

from functools import cache

import numpy as np

from herringbone.analysis.stability.amplification import Amplification
from herringbone.analysis.stability.bonds import highest_frequency
from herringbone.analysis.stability.linear_parts import linear_network
from herringbone.analysis.stability.steps.step_scan import unstable_bands
from herringbone.components.registry import COMPONENTS
from herringbone.cosim.structure.system_file import find_system, read_system
from herringbone.running.start import started
from herringbone.scenes import find_scene, read_scene

SEED = 2016
STIFFNESS = "radial_stiffness", "axial_stiffness"
DAMPING = "radial_damping", "axial_damping"


def variant(number, system):
    """Bearing stiffness x 0.1 to 100, bearing damping x 0.5 to 2, pinion mass x 0.5 to 2."""
    random = np.random.default_rng(SEED + number)
    bounds = ((0.1, 100.0), (0.5, 2.0), (0.5, 2.0))
    stiffness, damping, mass = (np.exp(random.uniform(*np.log(b))) for b in bounds)
    damping *= np.sqrt(stiffness)
    scale = {f"bearing_supports.{g}.{q}": stiffness for g in ("pinion", "wheel") for q in STIFFNESS}
    scale |= {f"bearing_supports.{g}.{q}": damping for g in ("pinion", "wheel") for q in DAMPING}
    scale |= {"gear_mesh.pinion.mass": mass, "gear_mesh.pinion.inertia": mass}
    return system.with_values({name: x * start(system, name) for name, x in scale.items()})


def start(system, path):
    """Value of a parameter in a system."""
    instance, name = system.split(path)
    part = system.part(instance)
    declared = COMPONENTS[part.component].declaration.variable(name).start
    return float(part.values.get(name, declared))


@cache
def rig(number=0):
    """The test rig under load, in equilibrium: 0 as it is, else a random variant."""
    scene = read_scene(find_scene(find_system("test_rig"), "loaded"))
    system = read_system("test_rig")
    return started(variant(number, system) if number else system, scene)[0]


@cache
def predicted(number, algorithm):
    """Growth over the step, and unstable bands [s]."""
    network, instances = linear_network(rig(number))
    growth = cache(Amplification(network, instances, algorithm).growth)
    if number == 0:
        return growth, unstable_bands(growth)
    frequency = highest_frequency(network, instances)  # stiffer bearings: a hundred times as high
    return growth, unstable_bands(growth, 0.02 / frequency, 25.0 / frequency)

"""A container FMU made of the native FMUs by the FMU Manipulation Toolbox, run by fmpy.

A container steps its FMUs in parallel on held inputs, which is
`Jacobi(order=0, schedule="parallel")` of this package.
"""

from dataclasses import replace

import fmpy
import numpy as np
import pytest

import herringbone as hb
from herringbone.cosim.algorithms import Jacobi
from herringbone.cosim.ssp.described import DescribedPart
from herringbone.cosim.structure.network import build_network
from herringbone.fmi.native import build_native_fmus
from herringbone.running.loading import load_scene, load_system
from herringbone.running.start import started

assembly = pytest.importorskip("fmu_manipulation_toolbox.assembly")

STEP, COUNT, EVERY = 1e-6, 400, 50
RECORDED = ("modal_housing.*.v_?", "*_coupling.torque", "gear_mesh.mesh_*.force")
PREFIX = "recorded."
"""Linked outputs are local variables of the container, by their own names."""


@pytest.fixture(scope="module")
def scene():
    _, folder = load_system("test_rig")
    loaded = load_scene(folder, "loaded")
    return replace(loaded, t_end=COUNT * STEP, record_step=EVERY * STEP)


@pytest.fixture(scope="module")
def ours(scene):
    parallel = Jacobi(order=0, schedule="parallel")
    return hb.run("test_rig", scene=scene, step=STEP, algorithm=parallel, fmu="native")


def make_container(system, files, described, outputs, fmi, folder):
    """A container of FMUs; `described` are their FMI 2.0 twins, which tell the connections."""
    parts = [DescribedPart(p.name, described[str(p.component)], p.values) for p in system.parts]
    network = build_network(system, parts)
    node = assembly.AssemblyNode(
        "test_rig.fmu", step_size=STEP, auto_link=False, auto_input=False, auto_output=False
    )
    names = [f"{part.name}.fmu" for part in parts]
    # In initialisation, values travel in this order from the FMUs at which loops are cut.
    for place in (*network.sources, *network.bodies, *network.elements):
        node.add_fmu(names[place], str(files[str(system.parts[place].component)]))
    for name, part in zip(names, parts, strict=True):
        for variable, _, text in part.typed_values():
            node.add_start_value(name, variable, text)
    for c in network.connections:
        node.add_link(names[c.source], c.output, names[c.target], c.input)
    for output in outputs:
        instance, variable = system.split(output)
        node.add_output(f"{instance}.fmu", variable, PREFIX + output)
    node.make_fmu(folder, fmi_version=fmi)
    return folder / node.name


@pytest.mark.parametrize("fmi", [2, 3])
def test_container_gives_our_results(fmi, scene, ours, native_fmus, tmp_path):
    system, _ = started(load_system("test_rig")[0], scene)
    outputs = [column for pattern in RECORDED for column in ours.columns(pattern)]
    files = build_native_fmus(fmi=fmi)
    file = make_container(system, files, native_fmus, outputs, fmi, tmp_path)
    found = fmpy.simulate_fmu(
        str(file),
        stop_time=COUNT * STEP,
        output_interval=EVERY * STEP,
        output=[PREFIX + output for output in outputs],
    )
    wanted = ours.data[outputs].to_numpy()
    assert (wanted[-1] != wanted[0]).all()
    np.testing.assert_array_equal(np.transpose([found[PREFIX + name] for name in outputs]), wanted)

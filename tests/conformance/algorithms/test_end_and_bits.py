"""Every algorithm hits the end exactly and gives the same bits twice."""

import pytest
from support.algorithms import check_determinism, check_end, every
from support.parts.running import run_in_process

from herringbone.cosim.algorithms import ALGORITHMS
from herringbone.cosim.structure.system_file import find_system, read_system
from herringbone.running.start import started
from herringbone.scenes import find_scene, read_scene


@every()
def test_end(algorithm):
    check_end(algorithm)


@every()
def test_same_bits(algorithm):
    check_determinism(algorithm)


@pytest.fixture(scope="module")
def rig():
    """The test rig, whose teeth open and close."""
    scene = read_scene(find_scene(find_system("test_rig"), "separation"))
    return started(read_system("test_rig"), scene)[0]


@pytest.mark.parametrize("name", ALGORITHMS)
def test_same_bits_on_the_rig(name, rig):
    algorithm = ALGORITHMS[name]()
    first, second = (run_in_process(rig, algorithm, 1e-5, 0.01) for _ in range(2))
    assert first.values.tobytes() == second.values.tobytes()

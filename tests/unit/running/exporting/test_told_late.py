"""An export says how to find what a master that steps all parts in parallel errs."""

import shlex

from herringbone.commands.main import _parser
from herringbone.cosim.algorithms import parse_algorithm
from herringbone.cosim.structure.system_file import read_system
from herringbone.running.exporting.parallel_step import PARALLEL, told_late


def test_the_command_is_one_that_runs():
    line = told_late("test_rig", read_system("test_rig"), 2e-6, changed=False)
    assert line.startswith("communication step 2e-06 s: ")
    command = shlex.split(line.split("'")[1])
    options = _parser().parse_args(command[1:])
    assert parse_algorithm(options.algorithm) == PARALLEL
    assert (options.system, options.step, options.reference) == ("test_rig", 2e-6, True)
    assert "of this export" not in line
    changed = told_late("test_rig", read_system("test_rig"), 2e-6, changed=True)
    assert "with the scene, values, gears and housings of this export tells" in changed

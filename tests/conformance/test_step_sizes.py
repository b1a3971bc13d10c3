"""Every call ends soon: a million micro steps are taken, and a longer step is refused.

In processes of their own, so that a step that never ends is a failure and no hang. Seconds are of
the CPU: other work of the machine does not count.
"""

import re
import subprocess
import sys

import pytest
from support.fmus import NAMES

from herringbone.components.registry import COMPONENTS
from herringbone.core.component import unbounded

STEPS = ("0.0", "1e-310", "1e-16", "1e3", "1e307", "inf", "nan", "-1.0")
_FMU = """
import sys
from time import process_time
from pathlib import Path
from herringbone.fmi.host import open_host
from herringbone.core import FmuError

name, file, *steps = sys.argv[1:]
for text in ("1e-6", *steps):
    with open_host(name, Path(file)) as part:
        part.initialise()
        begin = process_time()
        try:
            part.step(0.0, float(text))
            said = "done"
        except FmuError as error:
            said = str(error)
        print(process_time() - begin, said, flush=True)
"""
_IN_PROCESS = """
import sys
from time import process_time
import numpy as np
from herringbone.components.registry import component
from herringbone.components.in_process import InProcessPart
from herringbone.core import FmuError, Instance
from herringbone.cosim.loops.drive import drive

name, _, *steps = sys.argv[1:]
for text in ("1e-6", *steps):
    part = InProcessPart(Instance(component(name), name))
    part.enter_initialization(0.0, 1.0)
    part.exit_initialization()
    begin = process_time()
    try:
        drive(part, (), np.zeros((1, 0)), (), float(text))
        said = "done"
    except FmuError as error:
        said = str(error)
    print(process_time() - begin, said, flush=True)
"""


def stepped(program, name, file):
    """(CPU seconds, what is said) of one step of a fresh instance, for each of STEPS.

    A first step compiles what is not in the cache, and is left out.
    """
    found = subprocess.run(
        [sys.executable, "-c", program, name, str(file), *STEPS],
        capture_output=True, text=True, check=True, timeout=300,
    )  # fmt: skip
    _, *lines = (line.partition(" ") for line in found.stdout.splitlines())
    return {step: (float(line[0]), line[2]) for step, line in zip(STEPS, lines, strict=True)}


def expected(name, step):
    """Pattern of what is said."""
    if step in {"inf", "nan", "-1.0"}:
        return r"step size \S+ s; it must be 0 or positive|takes steps of|fails at (-?0|nan) s"
    longest = COMPONENTS[name].longest_step
    if longest is unbounded or (name, step) == ("modal_housing", "1e3"):
        return "^done$"
    return r"at most [\d.e+]+ s" if float(step) >= 1e3 else "^done$"


def check(program, name, file, seconds):
    for step, (elapsed, said) in stepped(program, name, file).items():
        assert re.search(expected(name, step), said), (step, said)
        assert elapsed < seconds, (step, elapsed)


@pytest.mark.parametrize("name", NAMES)
def test_python(python_fmus, name):
    """Of a refusal, the message compiles a function that tells the longest step."""
    check(_FMU, name, python_fmus[name], 60.0)


@pytest.mark.parametrize("name", NAMES)
def test_native(native_fmus, name):
    check(_FMU, name, native_fmus[name], 1.0)


@pytest.mark.parametrize("name", NAMES)
def test_in_process(name):
    check(_IN_PROCESS, name, "-", 60.0)

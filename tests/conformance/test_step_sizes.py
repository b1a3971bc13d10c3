"""Every call ends soon: a million micro steps are taken, and a longer step is refused.

In a process of their own for each kind, so that a step that never ends is a failure and no hang.
Seconds are of the CPU: other work of the machine does not count.
"""

import re
import subprocess
import sys

import pytest
from support.fmus import NAMES

from herringbone.components.registry import COMPONENTS
from herringbone.core.declaring.component import unbounded

STEPS = ("0.0", "1e-310", "1e-16", "1e3", "1e307", "inf", "nan", "-1.0")
_FMU = """
import sys
from time import process_time
from pathlib import Path
from herringbone.fmi.host import open_host
from herringbone.core import FmuError

steps, *parts = sys.argv[1:]
for name, file in zip(parts[::2], parts[1::2]):
    for text in ("1e-6", *steps.split()):
        with open_host(name, Path(file)) as part:
            part.initialise(stop_time=1e308)
            begin = process_time()
            try:
                part.step(0.0, float(text))
                said = "done"
            except FmuError as error:
                said = str(error)
            print(name, text, process_time() - begin, said, flush=True)
"""
_IN_PROCESS = """
import sys
from time import process_time
import numpy as np
from herringbone.components.registry import component
from herringbone.components.in_process import InProcessPart
from herringbone.core import FmuError, Instance
from herringbone.cosim.loops.drive import drive

steps, *parts = sys.argv[1:]
for name in parts[::2]:
    for text in ("1e-6", *steps.split()):
        part = InProcessPart(Instance(component(name), name))
        part.enter_initialization(0.0, 1.0)
        part.exit_initialization()
        begin = process_time()
        try:
            drive(part, (), np.zeros((1, 0)), (), float(text))
            said = "done"
        except FmuError as error:
            said = str(error)
        print(name, text, process_time() - begin, said, flush=True)
"""


def stepped(program, files):
    """(CPU seconds, what is said) of one step of a fresh instance, by component and step.

    A first step of 1e-6 s compiles what is not in the cache.
    """
    parts = [str(word) for pair in files.items() for word in pair]
    found = subprocess.run(
        [sys.executable, "-c", program, " ".join(STEPS), *parts],
        capture_output=True, text=True, check=True, timeout=600,
    )  # fmt: skip
    lines = (line.split(" ", 3) for line in found.stdout.splitlines())
    return {(name, step): (float(seconds), said) for name, step, seconds, said in lines}


def expected(name, step):
    """Pattern of what is said."""
    if step in {"inf", "nan", "-1.0"}:
        return r"step size \S+ s; it must be 0 or positive|takes steps of|fails at (-?0|nan) s"
    longest = COMPONENTS[name].longest_step
    if longest is unbounded or (name, step) == ("modal_housing", "1e3"):
        return "^done$"
    return r"at most [\d.e+]+ s" if float(step) >= 1e3 else "^done$"


def check(found, name, seconds):
    for step in STEPS:
        elapsed, said = found[name, step]
        assert re.search(expected(name, step), said), (step, said)
        assert elapsed < seconds, (step, elapsed)


@pytest.fixture(scope="module")
def python(python_fmus):
    return stepped(_FMU, python_fmus)


@pytest.fixture(scope="module")
def native(native_fmus):
    return stepped(_FMU, native_fmus)


@pytest.fixture(scope="module")
def in_process():
    return stepped(_IN_PROCESS, dict.fromkeys(NAMES, "-"))


@pytest.mark.parametrize("name", NAMES)
def test_python(python, name):
    """Of a refusal, the message compiles a function that tells the longest step."""
    check(python, name, 60.0)


@pytest.mark.parametrize("name", NAMES)
def test_native(native, name):
    check(native, name, 1.0)


@pytest.mark.parametrize("name", NAMES)
def test_in_process(in_process, name):
    check(in_process, name, 60.0)

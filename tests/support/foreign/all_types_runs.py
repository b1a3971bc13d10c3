"""Systems of the FMU that has variables of all types, and their runs."""

import re

import pytest

import herringbone as hb
from herringbone.core import HerringboneError
from herringbone.cosim.structure.system import PartSpec, System


def alone(file):
    return System("one", "", (PartSpec("p", fmu=file),), ())


def two(file, *connections):
    return System("two", "", (PartSpec("a", fmu=file), PartSpec("b", fmu=file)), connections)


def run(system, values, t_end=1.0, record_step=0.1, **options):
    named = {name if "." in name else f"p.{name}": value for name, value in values.items()}
    return hb.run(system, values=named, t_end=t_end, record_step=record_step, **options)


def refused(said, *arguments, **options):
    with pytest.raises(HerringboneError, match=re.escape(said)) as error:
        run(*arguments, **options)
    assert "\n" not in str(error.value)

"""Numba's debug lines and warnings: left out while kernels are compiled, and only then."""

import logging
import warnings

import pytest
from numba.core import byteflow, ssa
from numba.core.errors import NumbaWarning, WarningsFixer

from herringbone.kernels.compiling.dispatching import CFunction
from herringbone.kernels.compiling.jit import c_code
from herringbone.kernels.compiling.quiet import quiet


def code_of() -> str:
    """LLVM code of a function with branches, a loop and a variable of several assignments."""

    def function(x):
        found = 0.0
        for i in range(3):
            found = found + x * i if x > 1.0 else found - 1.0
        return found

    compiled: CFunction = c_code("float64(float64)", function)
    return str(compiled.code).replace(compiled.native_name, "")


def test_both_are_as_ever_outside_of_it():
    catch, loggers = WarningsFixer.catch_warnings, (byteflow._logger, ssa._logger)
    with quiet():
        with quiet():
            pass
        assert WarningsFixer.catch_warnings is not catch
        assert not {byteflow._logger, ssa._logger} & set(loggers)
    assert WarningsFixer.catch_warnings is catch
    assert (byteflow._logger, ssa._logger) == loggers


def test_warnings_arrive():
    fixer = WarningsFixer(NumbaWarning)
    with quiet(), pytest.warns(NumbaWarning, match="told"), fixer, fixer.catch_warnings():
        warnings.warn(NumbaWarning("told"), stacklevel=1)


def test_who_debugs_numba_hears_it(caplog):
    code_of()
    assert not caplog.records
    with caplog.at_level(logging.DEBUG, "numba.core.ssa"):
        code_of()
    assert {record.name for record in caplog.records} == {"numba.core.ssa"}


def test_kernels_do_without_filters_of_warnings(monkeypatch):
    """A failure here says that a version of numba catches warnings in another way."""

    def changed(*_):
        raise AssertionError("filters of warnings are changed")

    monkeypatch.setattr(warnings, "simplefilter", changed)
    assert "define" in code_of()

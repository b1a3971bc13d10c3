"""Fixtures that several test files share."""

import pytest

from herringbone.fmi import build_python_fmus
from herringbone.fmi.native import build_native_fmus, find_compiler, own_platform


@pytest.fixture(scope="session")
def python_fmus():
    """Path of the Python FMU by component."""
    return build_python_fmus()


@pytest.fixture(scope="session")
def native_fmus():
    """Path of the native FMU 2.0 of this platform by component."""
    platform = own_platform()
    if platform is None or find_compiler(platform) is None:
        pytest.skip("no C compiler for native FMUs was found")
    return build_native_fmus()


@pytest.fixture(scope="session")
def fmi3_fmus(native_fmus):
    """Path of the native FMU 3.0 of this platform by component."""
    return build_native_fmus(native_fmus, fmi=3)

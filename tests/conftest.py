"""Fixtures that several test files share."""

import pytest

from herringbone.fmi import build_python_fmus


@pytest.fixture(scope="session")
def python_fmus():
    """Path of the Python FMU by component."""
    return build_python_fmus()

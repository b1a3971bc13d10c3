"""Tests that build native FMUs of this platform are skipped where nothing compiles them."""

import pytest

from herringbone.fmi.native import find_compiler, own_platform

needs_compiler = pytest.mark.skipif(
    own_platform() is None or find_compiler(own_platform()) is None, reason="there is no C compiler"
)

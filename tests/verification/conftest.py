"""Fixtures of the verification tests."""

import pytest
from support.foreign.kinds import build_kinds


@pytest.fixture(scope="session")
def kinds(tmp_path_factory):
    """Folder of the FMUs in `tests/fmus/kinds`."""
    return build_kinds(tmp_path_factory.mktemp("kinds"))

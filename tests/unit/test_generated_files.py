"""Committed files that are generated are what would be generated now."""

import pytest

from herringbone.components.registry import COMPONENTS
from herringbone.core.paths import component_folder
from herringbone.fmi.readme import readme


@pytest.mark.parametrize("name", COMPONENTS)
def test_readme(name):
    committed = (component_folder(name) / "README.md").read_text(encoding="utf-8")
    assert committed == readme(COMPONENTS[name]), "run python -m herringbone.fmi.readme"

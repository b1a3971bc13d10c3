"""Finite elements in tests: skipped, with the reason, where the tools are missing."""

import pytest


def require_gmsh() -> None:
    """Skip the module unless scikit-fem and gmsh load (the extra fe)."""
    try:
        import gmsh  # noqa: F401
        import skfem  # noqa: F401
    except (ImportError, OSError) as error:  # OSError: gmsh misses a system library
        pytest.skip(f"finite elements take the extra fe: {error}", allow_module_level=True)

"""The import rule: who may import whom, and where heavy packages may appear."""

import ast
from functools import cache
from pathlib import Path

import pytest

from herringbone.core.places.paths import PACKAGE

ALLOWED: dict[str, set[str]] = {
    "core": set(),
    "kernels": {"core"},
    "gears": {"core", "components"},
    "components": {"core", "kernels"},
    "housing": {"core", "components"},
    "fmi": {"core", "kernels", "components"},
    "cosim": {"core", "kernels"},
    "analysis": {"core", "kernels", "components", "housing", "cosim", "result"},
    "scenes": {"core", "cosim", "analysis"},
    "result": {"core", "plotting"},
    "running": {
        "core",
        "components",
        "gears",
        "housing",
        "fmi",
        "cosim",
        "analysis",
        "scenes",
        "result",
        "plotting",
    },
    "studies": {
        "core",
        "components",
        "cosim",
        "analysis",
        "scenes",
        "result",
        "running",
        "plotting",
    },
    "thesis": {
        "core",
        "components",
        "gears",
        "housing",
        "cosim",
        "analysis",
        "scenes",
        "result",
        "running",
        "studies",
        "plotting",
    },
    "benchmarks": {"core", "fmi", "gears", "cosim", "analysis", "scenes", "result", "running"},
    "plotting": {"core", "gears", "analysis", "result"},
}
"""What a package or module may import of this package, besides itself; the rest stands on top."""

EXCEPTIONS: dict[str, set[str]] = {
    "fmi/check.py": {"cosim"},  # checks an FMU as the master would run it
    "fmi/host.py": {"cosim"},
    "analysis/accuracy/comparison.py": {"plotting"},  # draws itself, as a result does
    "analysis/accuracy/work_precision.py": {"plotting"},
    "analysis/steady/periodic.py": {"plotting"},
}
"""What single files may import besides."""

TOP = {"__init__", "__main__", "commands"}
"""Nothing below may import these; they may import everything."""

ONLY_IN: dict[str, set[str]] = {
    "numba": {"kernels", "cosim", "fmi/native/entry_points.py", "analysis/twin/core_part/calls.py"},
    "llvmlite": {
        "cosim/cell/atomics.py",
        "cosim/cell/inside/code.py",
        "cosim/cell/inside/loading.py",
        "cosim/loops/calls.py",
        "cosim/loops/float_modes.py",
        "cosim/fmu/fmi3/steps.py",
        "fmi/native/objects.py",
        "fmi/native/wide.py",
        "kernels/compiling/constants.py",
        "kernels/compiling/dispatching.py",
        "kernels/compiling/elements.py",
        "kernels/compiling/kept_pieces.py",
        "kernels/compiling/linking.py",
        "kernels/compiling/pieces.py",
        "kernels/compiling/simplifying.py",
    },
    "pythonfmu": {"fmi"},
    "fmpy": {"cosim", "fmi"},
    "matplotlib": {"plotting"},
    "pypardiso": {"housing/eigenmodes.py"},
    "gmsh": {"housing/welded/mesher.py"},
    "pyuff": {"core/reading/universal.py"},
    "skfem": {"housing/welded/elasticity.py", "gears/finite_elements/layer.py"},
}
"""Where heavy packages may be imported: folders or files of the package."""

FILES = sorted(PACKAGE.rglob("*.py"))


@cache
def imported(file: Path) -> list[tuple[str, ast.AST]]:
    """Modules that a file imports anywhere, type checking excluded."""
    tree = ast.parse(file.read_text(encoding="utf-8"))
    skipped = {
        id(inner)
        for node in ast.walk(tree)
        if isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING"
        for inner in ast.walk(node)
    }
    found = []
    for node in ast.walk(tree):
        if id(node) in skipped:
            continue
        if isinstance(node, ast.Import):
            found += [(alias.name, node) for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{file}:{node.lineno}: imports are absolute"
            module = node.module or ""
            if module == "herringbone":
                found += [(f"herringbone.{alias.name}", node) for alias in node.names]
            else:
                found.append((module, node))
    return found


def place(file: Path) -> str:
    """Package or module of a file, under `herringbone`."""
    return file.relative_to(PACKAGE).parts[0].removesuffix(".py")


def name_of(file: Path) -> str:
    return file.relative_to(PACKAGE).as_posix()


@pytest.mark.parametrize("file", FILES, ids=name_of)
def test_imports_within_the_package(file):
    here = place(file)
    assert here in ALLOWED or here in TOP, f"place {here} in ALLOWED or TOP"
    if here in TOP:
        return
    for module, node in imported(file):
        parts = module.split(".")
        if parts[0] == "herringbone" and len(parts) > 1:
            allowed = {here} | ALLOWED[here] | EXCEPTIONS.get(name_of(file), set())
            assert parts[1] in allowed, f"{file}:{node.lineno}: {here} may not import {parts[1]}"


def rooms_imported(file: Path) -> set[str]:
    """Rooms of the package that a file imports from, its own excluded."""
    found = (module.split(".") for module, _ in imported(file))
    return {p[1] for p in found if p[0] == "herringbone" and len(p) > 1} - {place(file)}


@pytest.mark.parametrize("here", ALLOWED)
def test_nothing_is_allowed_that_nobody_does(here):
    """Else a new import could pass unseen."""
    files = [file for file in FILES if place(file) == here]
    special = {file: EXCEPTIONS.get(name_of(file), set()) for file in files}
    used = set().union(*(rooms_imported(file) - special[file] for file in files))
    assert used == ALLOWED[here]
    for file in files:
        assert special[file] <= rooms_imported(file), name_of(file)


@pytest.mark.parametrize("heavy", ONLY_IN)
def test_heavy_packages_are_where_they_are_allowed(heavy):
    used = [file for file in FILES if heavy in {m.split(".")[0] for m, _ in imported(file)}]
    for where in ONLY_IN[heavy]:
        assert any(where in (place(file), name_of(file)) for file in used), where


@pytest.mark.parametrize("file", FILES, ids=name_of)
def test_heavy_packages(file):
    for module, node in imported(file):
        where = ONLY_IN.get(module.split(".")[0])
        if where is not None:
            allowed = place(file) in where or name_of(file) in where
            assert allowed, f"{file}:{node.lineno}: {module} only in {', '.join(sorted(where))}"


def test_rule_has_no_circle():
    """Who may import whom is an order, but for the lazy plots of a result."""
    seen: dict[str, bool] = {}

    def walk(name: str, path: tuple[str, ...]) -> None:
        assert name not in path, f"circle: {' -> '.join((*path, name))}"
        if not seen.get(name):
            for other in ALLOWED[name] - ({"plotting"} if name == "result" else set()):
                walk(other, (*path, name))
            seen[name] = True

    for name in ALLOWED:
        walk(name, ())


@pytest.mark.parametrize("heavy", ["plotting", "matplotlib"])
def test_plots_are_lazy(heavy):
    """Outside plotting they are imported in functions only."""
    for file in FILES:
        if place(file) == "plotting":
            continue
        for module, node in imported(file):
            if heavy in module.split("."):
                assert node.col_offset > 0, f"{file}:{node.lineno}: import {heavy} in a function"

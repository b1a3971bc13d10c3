"""Nobody outside the components knows one by its name: who needs one asks for its role."""

import ast
import re
from pathlib import Path

import pytest

from herringbone.components.registry import COMPONENTS
from herringbone.core.places.paths import PACKAGE

NAME = re.compile(rf"(?<![A-Za-z_])({'|'.join(COMPONENTS)})(?![a-z_])")
MODULES = {
    ".".join(file.relative_to(PACKAGE.parent).with_suffix("").parts)
    for file in (PACKAGE / "components").rglob("*")
    if "__pycache__" not in file.parts and file.stem.startswith(tuple(COMPONENTS))
}
FILES = sorted(f for f in PACKAGE.rglob("*.py") if "components" not in f.relative_to(PACKAGE).parts)


def naming(source: str) -> list[str]:
    """Line and text of every string or import that names a component."""
    found = []
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.ImportFrom):
            module = node.module or ""
            names = {module, *(f"{module}.{alias.name}" for alias in node.names)}
            found += [f"{node.lineno}: import of {name}" for name in sorted(names & MODULES)]
        elif isinstance(node, ast.Import):
            found += [f"{node.lineno}: {a.name}" for a in node.names if a.name in MODULES]
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            found += [f"{node.lineno}: {name}" for name in NAME.findall(node.value)]
    return found


def test_what_is_found():
    """The test sees names in docstrings, texts, formatted texts and imports."""
    name, module = next(iter(COMPONENTS)), sorted(MODULES)[0]
    seen = f'"""{name}"""\nx = "a.{name}.b"\ny = f"{{x}}{name}.w"\nfrom {module} import Z\n'
    assert len(naming(seen)) == 4
    assert {m.rpartition(".")[2] for m in MODULES} >= set(COMPONENTS)
    assert not naming(f'x = "{name}s, {name}_2"')


@pytest.mark.parametrize("file", FILES, ids=lambda f: f.relative_to(PACKAGE).as_posix())
def test_no_component_is_named(file: Path):
    assert not naming(file.read_text(encoding="utf-8")), "ask the registry for a role"

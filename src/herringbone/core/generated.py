"""Modules that are generated, written to the cache folder and imported from there.

A file, not `exec`, so that numba can cache what such a module compiles.
"""

import hashlib
import importlib.util
import os
import sys
import tempfile
from types import ModuleType

from herringbone.core.paths import cache_folder


def load_generated(kind: str, source: str) -> ModuleType:
    """Import a generated module, once per process; its name follows from its content.

    Args:
        kind: what it is, such as "twin"; becomes part of its name.
        source: Python source.
    """
    digest = hashlib.sha256(source.encode()).hexdigest()[:16]
    name = f"herringbone_{kind}_{digest}"
    if name in sys.modules:
        return sys.modules[name]
    file = cache_folder("generated") / f"{name}.py"
    if not file.is_file():
        with tempfile.NamedTemporaryFile(
            "w", dir=file.parent, suffix=".part", delete=False, encoding="utf-8"
        ) as part:
            part.write(source)
        os.replace(part.name, file)  # noqa: PTH105 (atomic on all platforms)
    spec = importlib.util.spec_from_file_location(name, file)
    module = importlib.util.module_from_spec(spec)  # type: ignore[arg-type]
    sys.modules[name] = module
    spec.loader.exec_module(module)  # type: ignore[union-attr]
    return module

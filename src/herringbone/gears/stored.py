"""Arrays that take long to compute, kept in the cache folder by what they follow from."""

import io
from collections.abc import Callable, Mapping
from dataclasses import fields, is_dataclass
from numbers import Integral, Real

import numpy as np

from herringbone.core.caching.files import read_stored, store
from herringbone.core.caching.keys import digest_of, kernels_key, versions_of
from herringbone.core.places.paths import cache_folder

_LIBRARIES = ("numpy", "scipy", "scikit-fem")

Arrays = dict[str, np.ndarray]


def content_key(module: str, *values: object) -> str:
    """Key of what a module of the package computes from values.

    Args:
        module: whose syntax, and that of all modules that it imports, decides.
        values: numbers, texts, and sequences and dataclasses of such.

    Raises:
        TypeError: a value of another type.
    """
    return digest_of(kernels_key(module), *versions_of(*_LIBRARIES), _text(values))


def _text(value: object) -> str:
    """A value with all of its digits; unlike `repr`, which a class may shorten for people."""
    if is_dataclass(value) and not isinstance(value, type):
        named = (f"{field.name}={_text(getattr(value, field.name))}" for field in fields(value))
        return f"{type(value).__name__}({','.join(named)})"
    if isinstance(value, tuple | list):
        return f"({','.join(map(_text, value))})"
    if value is None or isinstance(value, bool | str):
        return repr(value)
    if isinstance(value, Integral):
        return repr(int(value))
    if isinstance(value, Real):
        return repr(float(value))
    raise TypeError(f"{value!r} of {type(value).__name__} has no place in a key")


def stored_arrays(kind: str, key: str, make: Callable[[], Mapping[str, np.ndarray]]) -> Arrays:
    """Arrays out of the cache, or made and put there.

    Args:
        kind: folder of the cache.
        key: see `content_key`.
        make: computes them.

    Raises:
        ResourceError: the cache folder cannot be made.
    """
    file = cache_folder(kind) / f"{key}.npz"
    content = read_stored(file)
    if content is None:
        buffer = io.BytesIO()
        np.savez(buffer, allow_pickle=False, **make())
        content = buffer.getvalue()
        store(file, content)
    with np.load(io.BytesIO(content), allow_pickle=False) as found:
        return dict(found)

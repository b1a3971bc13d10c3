"""What the step of a system as one component is compiled from, as one digest."""

import pickle
from dataclasses import replace
from types import ModuleType

from herringbone.core import Declaration
from herringbone.core.caching.keys import digest_of, module_key


def content_of(
    declaration: Declaration, module: ModuleType, found: tuple, factory: ModuleType
) -> str:
    """Digest of the sources, of the layout, and of the form.

    Start values are left out, so that another operating point needs no compilation.

    Args:
        declaration: of the component.
        module: its kernels.
        found: how it steps; numbers and arrays.
        factory: module that makes the step.
    """
    d = declaration
    return digest_of(
        *(module_key(m.__name__, str(m.__file__)) for m in (factory, module)),
        repr([replace(v, start=0.0) for v in d.variables]),
        repr((d.index, d.size, d.work, d.tables, d.first_kept, d.hidden_states)),
        pickle.dumps(found),
    )

"""Start values of a foreign part's inputs, kept by what they depend on."""

from collections.abc import Callable, Sequence

import numpy as np

from herringbone.core.caching.files import keep, kept
from herringbone.core.caching.keys import digest_of, kernels_key
from herringbone.core.caching.tried import tried_folder
from herringbone.core.part import Part

_SOURCES = "herringbone.running.foreign.start_inputs", "herringbone.cosim.fmu.opening"


def start_inputs(part: Part, inputs: Sequence[str]) -> np.ndarray:
    """(n,) start values of inputs, as an instance has them when it is initialised; it is closed."""
    try:
        part.enter_initialization(0.0, 1.0)
        return np.array(part.get(inputs))
    finally:
        part.close()


def known_start_inputs(
    make: Callable[[], Part], inputs: Sequence[str], content: Sequence[str]
) -> np.ndarray:
    """The same, of an instance that is made if they are not known from before.

    Args:
        make: makes it.
        inputs: names of real inputs.
        content: what `make` depends on; empty: they are not kept.

    Raises:
        FmuError: the part does not instantiate or initialise.
    """
    if not content:
        return start_inputs(make(), inputs)
    key = digest_of(kernels_key(*_SOURCES), *content, repr(tuple(inputs)))
    file = tried_folder("inputs") / f"{key}.json"
    if (known := kept(file)) is None:
        keep(file, known := start_inputs(make(), inputs).tolist())
    return np.array(known, dtype=float)

"""What is made once, though several test processes ask for it."""

from herringbone.core.caching.files import alone_in
from herringbone.core.places.paths import cache_folder


def alone(what):
    """Context for one process at a time: what one test process builds, the others find built."""
    return alone_in(cache_folder("being-made") / what)

"""The test rig as one component, whose step takes ten seconds to compile, and is kept."""

from functools import cache

from herringbone.analysis.twin.composite import Composite, make_composite
from herringbone.running.prepared import Wishes, prepared


@cache
def rig_as_one() -> Composite:
    """Under load."""
    return make_composite(prepared("test_rig", "loaded", Wishes()).system)

"""A start in equilibrium with foreign parts, on the flanks that carry; it is looked for once.

What is found is kept, and so is why there is none: either takes seconds of steps of the FMUs.
"""

from collections.abc import Mapping
from dataclasses import asdict

from herringbone.core.caching.files import keep, kept
from herringbone.core.caching.keys import digest_of, kernels_key, versions_of
from herringbone.core.caching.tried import tried_folder
from herringbone.cosim.structure.approach import Approach, SteadyInput
from herringbone.cosim.structure.system import System
from herringbone.running.content import contents_of_system
from herringbone.running.pairs.carrying_flank import COAST, coasts, free_flanks
from herringbone.running.settling.held import NOT_WANTED, Wanted
from herringbone.running.settling.search import SettledStart
from herringbone.running.settling.settled_start import settled_start
from herringbone.running.settling.stranger import NeverSettlesError, NoSettledStartError

_SOURCES = ("herringbone.running.settling.settled_start",)
_LIBRARIES = "numpy", "scipy"
_NEVER = "never"
"""Name under which it is kept why there is no such start."""


def loaded_settled_start(
    system: System, known: System, step: float, wanted: Wanted = NOT_WANTED
) -> tuple[SettledStart, list[str]]:
    """As `settled_start`, with the flanks that carry among the values, and lines on these.

    Raises:
        NoSettledStartError: there is none on either flank.
    """
    flanks, wrong = free_flanks(known), None
    try:
        found = _known_start(system, known, step, wanted)
        coasting = [gear for gear in flanks if coasts(known.with_values(found.values), gear)]
    except NoSettledStartError as error:
        wrong, coasting = error, list(flanks)
    if not coasting:
        if wrong:
            raise wrong
        return found, []
    try:
        return _coasting(system, known, step, wanted, {gear: flanks[gear] for gear in coasting})
    except NoSettledStartError as error:
        raise (wrong or error) from None


def _coasting(
    system: System,
    known: System,
    step: float,
    wanted: Wanted,
    flanks: Mapping[str, list[str]],
) -> tuple[SettledStart, list[str]]:
    """The start with gear pairs on their coast flanks; raises NoSettledStartError."""
    chosen = {path: COAST for paths in flanks.values() for path in paths}
    turned = known.with_values(chosen)
    found = _known_start(system.with_values(chosen), turned, step, wanted)
    for gear in flanks:
        if not coasts(turned.with_values(found.values), gear):
            raise NoSettledStartError(f"no flank of {gear} carries for good")
    lines = [f"{gear}: the coast flank carries; y is its line of action" for gear in flanks]
    return found._replace(values={**chosen, **found.values}), lines


def _known_start(system: System, known: System, step: float, wanted: Wanted) -> SettledStart:
    """The start that was found before, or is found now and kept; it may take seconds.

    Raises:
        NoSettledStartError: there is none, or none was found.
    """
    key = digest_of(
        kernels_key(*_SOURCES),
        *versions_of(*_LIBRARIES),
        *contents_of_system(system),
        repr(step),
        *map(str, wanted),
    )
    file = tried_folder("starts") / f"{key}.json"
    if (plain := kept(file)) is not None:
        if _NEVER in plain:
            raise NeverSettlesError(plain[_NEVER])
        approaches = {name: _approach(way) for name, way in plain["approaches"].items()}
        return SettledStart(**{**plain, "approaches": approaches})
    try:
        found = settled_start(system, known, step, wanted)
    except NeverSettlesError as error:
        keep(file, {_NEVER: str(error)})
        raise
    ways = {str(name): asdict(way) for name, way in found.approaches.items()}
    keep(file, {**found._asdict(), "values": dict(found.values), "approaches": ways})
    return found


def _approach(plain: Mapping) -> Approach:
    inputs = tuple(SteadyInput(**u) for u in plain["inputs"])
    return Approach(**{**plain, "inputs": inputs})

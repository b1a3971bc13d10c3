"""What follows from a system alone, found once in a process: steady rotation, bonds, stability.

What a process asks first its next one finds in the cache.
"""

from collections.abc import Callable

from herringbone.analysis.stability.limits import fastest_bond
from herringbone.core.caching.answers import FirstAsked
from herringbone.core.caching.keys import digest_of
from herringbone.core.caching.remembered import Remembered
from herringbone.cosim.algorithms import Algorithm
from herringbone.cosim.structure.system import System, Values
from herringbone.running.content import contents_of_system
from herringbone.running.pairs.carrying_flank import loaded_start

_MOST = 256
_starts: Remembered[tuple[Values, tuple[str, ...]]] = Remembered(_MOST)
_bonds: Remembered[float | None] = Remembered(_MOST)
_warnings: Remembered[str | None] = Remembered(_MOST)
_first_starts, _first_bonds, _first_warnings = (
    FirstAsked(__name__, "herringbone.running.coupling_choice") for _ in range(3)
)
"""The second module asks, and knows how to find."""


def start_of_known(system: System) -> tuple[Values, tuple[str, ...]]:
    """See `loaded_start`."""
    key = _key(system)
    values, lines = _starts(
        key, lambda: _first_starts(f"start {key}", lambda: loaded_start(system))
    )
    return dict(values), tuple(lines)


def bond_of(system: System) -> float | None:
    """See `fastest_bond`."""
    key = _key(system)
    return _bonds(key, lambda: _first_bonds(f"bond {key}", lambda: fastest_bond(system)))


def stability_warning(
    system: System,
    algorithm: Algorithm,
    step: float,
    t_end: float,
    find: Callable[[], str | None],
) -> str | None:
    """See `warn_if_unstable`; of foreign parts the start is part of the question.

    Args:
        system: at its start.
        algorithm, step, t_end: of the run.
        find: predicts; what it raises is raised, and not kept.
    """
    ways = digest_of(*(repr(spec.approach) for spec in system.parts))
    key = f"{_key(system)} {ways} {algorithm!r} {step!r} {t_end!r}"
    return _warnings(key, lambda: _first_warnings(key, find))


def _key(system: System) -> str:
    return digest_of(system.name, *contents_of_system(system))

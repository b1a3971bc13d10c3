"""Short names of algorithms that are compared."""

from herringbone.cosim.algorithms import ALGORITHMS


def variant_labels(algorithms: tuple[str, ...]) -> dict[str, str]:
    """Short names, as the command takes them.

    They have the options that are not the default or in which variants of the same algorithm
    differ, and at least the first one.
    """
    found = {}
    for algorithm in algorithms:
        family, values = _options(algorithm)
        usual = _options(str(ALGORITHMS[family]()))[1] if family in ALGORITHMS else {}
        others = [own for kind, own in map(_options, algorithms) if kind == family]
        shown = [
            option
            for k, option in values.items()
            if usual.get(k) != option or any(own.get(k) != option for own in others)
        ]
        said = ",".join(shown or [*values.values()][:1])
        found[algorithm] = f"{family}:{said}" if said else family
    return found


def _options(algorithm: str) -> tuple[str, dict[str, str]]:
    """`li:degree=3` -> ("li", {"degree": "degree=3"})."""
    family, _, options = algorithm.partition(":")
    return family, {o.partition("=")[0]: o for o in options.split(",") if o}

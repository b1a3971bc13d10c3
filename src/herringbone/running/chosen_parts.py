"""Which part of a system an option means that names a role: the gear pair, the housing."""

from herringbone.analysis.anatomy import anatomy
from herringbone.core import ParameterError
from herringbone.core.declaring.roles import Role
from herringbone.core.places.part_path import PartPath
from herringbone.cosim.structure.system import System


def part_for(system: System, role: Role, asked: str, option: str) -> PartPath:
    """The part of a role, by its path or that of a system around it.

    Args:
        system: whose parts.
        role: of the part.
        asked: path or ending of one; "": the only one that there is.
        option: what asks, for messages.

    Raises:
        ParameterError: there is none, or there are several.
    """
    every = [PartPath(name) for name in anatomy(system).with_role(role)]
    if not every:
        raise ParameterError(f"{option}: {system.name} has no {role}")
    found = [part for part in every if not asked or _means(asked, part)]
    if len(found) == 1:
        return found[0]
    if not found:
        raise ParameterError(f"{option}: '{asked}' is none of {', '.join(every)}")
    raise ParameterError(
        f"{option}: {system.name} has several parts that are a {role}; "
        f"give PATH=FILE with one of {', '.join(found)}"
    )


def _means(asked: str, part: PartPath) -> bool:
    """True if a path is that of the part, of a system around it, or an ending of one of them."""
    names = part.split(".")
    around = [PartPath(".".join(names[:k])) for k in range(1, len(names) + 1)]
    return any(path.answers_to(asked) for path in around)

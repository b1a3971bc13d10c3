"""The form in which a gearbox for hosts is condensed, and when it can be."""

from types import ModuleType

import numpy as np

from herringbone.analysis.hosted.boundary import Boundary
from herringbone.analysis.hosted.core_source import laws_of_parts
from herringbone.analysis.hosted.places import Places, coordinates
from herringbone.analysis.twin.composite_parts import Parts
from herringbone.analysis.twin.condensed.rungs import LOBATTO, coefficients, continued
from herringbone.core import StructureError
from herringbone.core.declaring.hosting import Given
from herringbone.kernels.condensed.in_block.form import Equations, Form

DEGREE = 4
LENGTHS = (1e-3 / 15.0, 5e-5, 4e-5, 2.5e-5)


def can_be_condensed(boundary: Boundary, parts: Parts) -> bool:
    """True if the host gives torques alone, and the parts are linear beside laws without clock."""
    if any(f.given is not Given.TORQUE for f in boundary.flanges):
        return False
    if parts.network.sources:
        return False
    try:
        laws = laws_of_parts(parts)
    except StructureError:
        return False
    return bool(laws) and all(own.clock is None for own in laws.values())


def core_form(parts: Parts, inputs: int) -> Form:
    """The form; mean tangents are those of the parameters as they are exported.

    Other ones are as good for the solution, but take more iterations.
    """
    laws = laws_of_parts(parts)
    stiff: list[int] = []
    of_tangent: list[int] = []
    directions: list[np.ndarray] = []
    mean: list[np.ndarray] = []
    arguments = sum(len(own.arguments) for own in laws.values())
    value = at = 0
    for p, own in laws.items():
        block = parts.instances[p].block
        unknown = sorted(set(own.stiff))
        of_tangent += [len(stiff) + unknown.index(v) for v in own.stiff]
        stiff += [value + v for v in unknown]
        rows = own.directions(block)
        whole = np.zeros((len(rows), arguments))
        whole[:, at : at + rows.shape[1]] = rows
        directions.append(whole)
        mean.append(own.mean(block))
        value, at = value + len(own.values), at + len(own.arguments)
    return Form(
        states=parts.layout.state_first[-1],
        arguments=arguments,
        values=value,
        kinks=sum(own.kinks for own in laws.values()),
        stiff=tuple(stiff),
        of_tangent=tuple(of_tangent),
        directions=np.concatenate(directions),
        mean=np.concatenate(mean),
        inputs=inputs,
        nodes=np.array(LOBATTO[DEGREE]),
        fit=coefficients(DEGREE),
        ahead=continued(DEGREE, DEGREE, 1.0),
        lengths=LENGTHS,
    )


def core_equations(
    boundary: Boundary, parts: Parts, places: Places, module: ModuleType
) -> Equations:
    """The kernels of the form."""
    d = places.declaration
    (turning,) = (c.x for c in coordinates(boundary, parts) if c.turns)
    return Equations(
        d.name,
        turning,
        tuple(d.index[v.name] for v in d.inputs),
        places.state_sizes,
        module.system_rhs,
        module.core_given,
        module.core_prepare,
        module.core_laws,
        module.core_period,
    )

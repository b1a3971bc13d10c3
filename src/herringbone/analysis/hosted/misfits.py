"""What a gearbox for hosts says of its housing, which may be that of another gear pair."""

from collections.abc import Iterator

from herringbone.analysis.anatomy import anatomy
from herringbone.analysis.figures.misfits.housings import seats_elsewhere
from herringbone.analysis.figures.modal_response import housing_in
from herringbone.analysis.hosted.boundary import Boundary
from herringbone.analysis.twin.composite_parts import Parts
from herringbone.core import Instance
from herringbone.core.declaring.roles import GEARS, PortKind, Quantity, Role


def misfits(boundary: Boundary, parts: Parts) -> Iterator[str]:
    """Lines on a housing whose seats are not where the pair wants them, as after a run."""
    known, of = anatomy(boundary.system), {i.name: i for i in parts.instances}
    bearing = known.neighbour(boundary.pair, PortKind.JOURNAL, Role.BEARING)
    part = bearing and known.neighbour(bearing, PortKind.SEAT, Role.HOUSING)
    if not bearing or not part:
        return
    files = {
        t.quantity: of[part].resources / of[part].texts[t.name]
        for t in of[part].component.declaration.texts
    }
    if not {Quantity.MODES, Quantity.SHAPES} <= files.keys():
        return
    housing = housing_in(files[Quantity.MODES], files[Quantity.SHAPES])
    if housing is None:
        return
    radii = _values(of[boundary.pair], Quantity.BASE_RADIUS)
    angle = _values(of[bearing], Quantity.WORKING_PRESSURE_ANGLE).get("")
    both = (radii[GEARS[0]], radii[GEARS[1]]) if radii.keys() >= set(GEARS) else None
    yield from seats_elsewhere((part, boundary.pair, bearing), housing, both, angle)


def _values(instance: Instance, quantity: Quantity) -> dict[str, float]:
    """Values of the variables of a quantity, by their place."""
    offered = instance.component.declaration.offered(quantity)
    return {v.place: instance[v.name] for v in offered}

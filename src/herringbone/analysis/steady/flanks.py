"""Whether the flanks carry for which a system was prepared: y is the line of action of these."""

import numpy as np

from herringbone.analysis.anatomy import anatomy
from herringbone.analysis.steady.harmonic_balance.orbit import Orbit
from herringbone.analysis.steady.outputs import harmonics
from herringbone.analysis.steady.structure import Structure
from herringbone.core.declaring.roles import Quantity, Role


def prepared_flanks(structure: Structure) -> dict[str, float]:
    """The flank for which each gear pair was prepared, 1 drive, -1 coast."""
    known, twin = anatomy(structure.system), structure.core.twin
    found = {
        gear: known.column(gear, Quantity.CARRYING_FLANK)
        for gear in known.with_role(Role.GEAR_PAIR)
    }
    return {gear: float(twin.block[twin.index(path)]) for gear, path in found.items() if path}


def on_other_flank(structure: Structure, orbit: Orbit) -> tuple[str, ...]:
    """Gear pairs whose mean mesh force is on another flank than they were prepared for."""
    known, flanks = anatomy(structure.system), prepared_flanks(structure)
    columns = {gear: known.columns(gear, Quantity.MESH_FORCE) for gear in flanks}
    forces = {
        gear: np.sum(harmonics(structure, orbit, own).coefficients[:, 0].real)
        for gear, own in columns.items()
        if own
    }
    return tuple(gear for gear, force in forces.items() if force * flanks[gear] < 0.0)

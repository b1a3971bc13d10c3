"""Declaration of the modal housing, and where everything lies in its block and its work space."""

from herringbone.components.ports import HALVES, seats
from herringbone.components.resources import modal_data
from herringbone.core import Declaration, StateVector, Text, Variable, input_, output, parameter
from herringbone.core.declaring.roles import Quantity, Role
from herringbone.kernels import modal
from herringbone.kernels.signals import STRIDE

MODES = 64
"""Most modes that the component takes."""
DOFS = tuple((seat, axis) for seat in HALVES for axis in "xyz")
DOF_COUNT = len(DOFS)
AXES = 3
SEATS = DOF_COUNT // AXES
_FORCES = tuple(f"{seat}.f_{axis}" for seat, axis in DOFS)


def _port(seat: str, axis: str) -> list[Variable]:
    at = f"of {seat} along {axis}"
    force, s, v, a = (f"{seat}.{q}_{axis}" for q in "fsva")
    return [
        input_(force, "N", f"force on the housing at {seat} along {axis}"),
        output(s, "m", f"position {at}", nodes=True, rate=v),
        output(v, "m/s", f"velocity {at}", nodes=True, rate=a),
        output(a, "m/s2", f"acceleration {at}", feedthrough=_FORCES),
        parameter(
            f"start.{force}", "N", "force under which the start is at rest", 0.0, at_rest=force
        ),
    ]


# Tables: number of modes, angular frequency, damping ratio, shapes by dof, modal accelerations,
# partial sums of a degree of freedom.
PARTIAL = 8
_TABLE_SIZE = 1 + MODES * (2 + DOF_COUNT + 1) + PARTIAL
STEPS = 24
"""Steps whose propagators are kept, for masters that come back to a step."""
# Work: slots filled so far, step of each slot, slots of propagators (by entry, then by mode), room
# for one propagator and for its making, polynomial forces by dof, the same by mode.
FILLED, STEP_OF = 0, 1
PROPAGATORS = STEP_OF + STEPS
SLOT = MODES * modal.PROPAGATOR
ONE = PROPAGATORS + STEPS * SLOT
SCRATCH = ONE + modal.PROPAGATOR
POLYNOMIALS = SCRATCH + modal.SCRATCH_SIZE
MODAL = POLYNOMIALS + DOF_COUNT * STRIDE
_WORK = MODAL + modal.DEGREES * MODES

DECLARATION = Declaration(
    "modal_housing",
    "Gearbox housing as oscillators with shapes at the four bearing seats",
    [v for seat, axis in DOFS for v in _port(seat, axis)],
    texts=[
        Text(
            "modes",
            "frequencies and damping, CSV",
            "modes.csv",
            modal_data.MODE_COLUMNS,
            Quantity.MODES,
        ),
        Text(
            "shapes",
            "mass-normalised shapes at the seats, CSV",
            "shapes.csv",
            modal_data.shape_columns(DOFS),
            Quantity.SHAPES,
        ),
    ],
    vectors=[
        StateVector(name, unit, f"modal {what}", MODES, "modes", "modes")
        for name, unit, what in (
            ("q", "kg^1/2.m", "coordinate"),
            ("der(q)", "kg^1/2.m/s", "velocity"),
        )
    ],
    tables=_TABLE_SIZE,
    work=_WORK,
    roles=[Role.HOUSING],
    ports=seats(),
)

START_FORCES = DECLARATION.index[f"start.{_FORCES[0]}"]
S, V, A = (DECLARATION.index[f"{DOFS[0][0]}.{q}_{DOFS[0][1]}"] for q in "sva")
"""Motion of the first degree of freedom; the next ones follow, 2 STRIDE apart, accelerations 1."""
FIRST_INPUT, FIRST_OUTPUT, OUTPUTS = (
    DECLARATION.first_input,
    DECLARATION.first_output,
    len(DECLARATION.node_outputs),
)
DEGREE = DECLARATION.index["interface_degree"]
COUNT = DECLARATION.first_table
OMEGA = COUNT + 1
ZETA = OMEGA + MODES
SHAPES = ZETA + MODES
ACCELERATIONS = SHAPES + DOF_COUNT * MODES
SUMS = ACCELERATIONS + MODES

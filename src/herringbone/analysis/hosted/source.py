"""Source of the kernels that a gearbox for hosts has besides its parts.

**Flanges.** The end of a shaft has the angle phi + w (t - t_set) + offset, where the host holds
the angle phi that it set at t_set; while it gives nodes or derivatives, phi + offset alone. Where
it gives speed alone, phi is a state. tau_mean is the integral of tau since the start of the step,
over the time since then. Inside a step, time counts from its start, so that a start time does not
change a bit.

**Equilibrium.** Unknown are the elastic coordinates, at rest, and the offsets; wanted is that no
elastic coordinate is accelerated, and that shafts carry their initial torques. The whole turns with
the start speed, and is accelerated by what is left over of the torques. The angle stays 0. It is
searched with the teeth in contact on the drive flank, then on the coast flank.
"""

from dataclasses import dataclass

from herringbone.analysis.twin.composite_source import OwnLines


@dataclass(frozen=True)
class FlangePlaces:
    """Places of a flange that has a shaft; -1: it has none of it.

    Attributes:
        phi, w: inputs.
        angle, impulse: states.
        offset, lead, tau_mean, initial_torque: as in the declaration.
        end_phi, end_w, end_tau, gear_tau, gear_w, stiffness: in the blocks of the parts.
    """

    phi: int
    w: int
    angle: int
    impulse: int
    offset: int
    lead: int
    tau_mean: int
    initial_torque: int
    end_phi: int
    end_w: int
    end_tau: int
    gear_tau: int
    gear_w: int
    stiffness: int


@dataclass(frozen=True)
class StartPlaces:
    """Places that the search for the equilibrium needs.

    Attributes:
        first, own, states: start of the parts' blocks, number of own states and of all.
        unknowns, sizes: elastic coordinates, and their usual sizes.
        rows: states whose derivatives are to vanish.
        state_sizes: usual sizes of all states.
        speed: state of the pinion's speed.
        initial_speed: parameter; -1: the first shaft gives it.
        start_mode, flank, inner_step, step_start, stepping, degree: as in the declaration.
        guesses: by coordinate: where the search begins on the drive and on the coast flank.
        forces: mesh forces in the blocks of the parts.
        locals: pairs: local, and its place in the blocks of the parts.
        keeps_states: states are set by the host if the start is as set.
        scratch: room in the block.
        owner: name of the component.
    """

    first: int
    own: int
    states: int
    unknowns: tuple[int, ...]
    sizes: tuple[float, ...]
    rows: tuple[int, ...]
    state_sizes: tuple[float, ...]
    speed: int
    initial_speed: int
    start_mode: int
    flank: int
    inner_step: int
    step_start: int
    stepping: int
    degree: int
    guesses: tuple[tuple[int, int, int], ...]
    forces: tuple[int, ...]
    locals: tuple[tuple[int, int], ...]
    keeps_states: bool
    scratch: int
    owner: str


_KERNELS = """

from herringbone.kernels.stepping.adaptive import LARGEST
from herringbone.kernels.stepping.newton import NOT_FOUND, SETTLED, newton_solver
from herringbone.kernels.spectral_radius import spectral_radius

UNKNOWNS = {unknowns!r}
SIZES = {sizes!r}
STATE_SIZES = {state_sizes!r}
ROWS = {rows!r}
DERIVATIVES = {derivatives}
TRIALS = (0.0, 3.0, 15.0)
PART = 2.0


@kernel
def residual(b: np.ndarray, t: float, r: np.ndarray) -> None:
    blocks = b[{first}:]
    dx = b[DERIVATIVES : DERIVATIVES + {states}]
    system_rhs(b, t, dx)
    for i in range({count}):
        r[i] = dx[ROWS[i]]
{torques}    return


search = newton_solver(residual, UNKNOWNS, SIZES, {scratch}, "{owner}")
radius = spectral_radius(system_rhs, STATE_SIZES, {scratch}, "{owner}")


@kernel
def undeformed(b: np.ndarray, t: float) -> None:
    blocks = b[{first}:]
    for i in range({states}):
        b[i] = 0.0
    b[{speed}] = 1.0
    refresh(b)
    scatter(blocks, b[{own}:{states}])
    propagate(blocks, t)
{speeds}

@kernel
def twisted(b: np.ndarray, t: float) -> None:
    blocks = b[{first}:]
    refresh(b)
    scatter(blocks, b[{own}:{states}])
    place(b, t)
    propagate(blocks, t)
    propagate(blocks, t)
{offsets}    return


@kernel
def on_flank(b: np.ndarray, t: float, flank: float) -> int:
    blocks = b[{first}:]
    for k in range(len(TRIALS)):
        b[{flank}] = flank
        undeformed(b, t)
        for i in range({guess_count}):
            drive = b[GUESSES[i][1]]
            guess = drive if flank > 0.0 else b[GUESSES[i][2]]
            b[GUESSES[i][0]] = guess + flank * TRIALS[k] * drive
        if search(b, t) == SETTLED:
            force = 0.0
            scatter(blocks, b[{own}:{states}])
            propagate(blocks, t)
{forces}            if force * flank >= 0.0:
                return SETTLED
    return NOT_FOUND


@kernel
def settle(b: np.ndarray, t: float) -> int:
    blocks = b[{first}:]
    status = SETTLED
    b[{step_start}] = t
    if b[{start_mode}] == 0.0:
        b[{flank}] = 1.0
{as_set}    else:
        status = on_flank(b, t, 1.0)
        if status != SETTLED:
            status = on_flank(b, t, -1.0)
        if status != SETTLED:
            b[{flank}] = 1.0
            undeformed(b, t)
            twisted(b, t)
    fastest = radius(b, t)
    b[{inner_step}] = LARGEST
    if fastest > 0.0:
        b[{inner_step}] = min(LARGEST, PART / fastest)
    refresh(b)
    scatter(blocks, b[{own}:{states}])
{starts}{keep}    return status
"""


def own_lines(flanges: list[FlangePlaces], start: StartPlaces, starts: str) -> OwnLines:
    """The lines; `starts` calls the parts' start kernels on their blocks."""
    return OwnLines(
        "".join(_place(f, start) for f in flanges),
        "".join(_rates(f) for f in flanges),
        "".join(_results(f, start) for f in flanges),
        _start(flanges, start, starts),
    )


def _place(f: FlangePlaces, s: StartPlaces) -> str:
    if f.angle >= 0:
        angle = f"    blocks[{f.end_phi}] = b[{f.angle}] + b[{f.offset}]\n"
    else:
        angle = (
            f"    blocks[{f.end_phi}] = b[{f.phi}] + b[{f.offset}]\n"
            f"    if b[{s.degree}] == 0.0 and b[{s.stepping}] != 0.0:\n"
            f"        blocks[{f.end_phi}] += b[{f.w}] * (b[{f.lead}] + t)\n"
        )
    return angle + f"    blocks[{f.end_w}] = b[{f.w}]\n"


def _rates(f: FlangePlaces) -> str:
    angle = f"    dx[{f.angle}] = b[{f.w}]\n" if f.angle >= 0 else ""
    return angle + f"    dx[{f.impulse}] = blocks[{f.end_tau}]\n"


def _results(f: FlangePlaces, s: StartPlaces) -> str:
    return (
        f"    since = t\n"
        f"    if b[{s.stepping}] == 0.0:\n"
        f"        since = t - b[{s.step_start}]\n"
        f"    b[{f.tau_mean}] = blocks[{f.end_tau}]\n"
        f"    if since > 0.0:\n"
        f"        b[{f.tau_mean}] = b[{f.impulse}] / since\n"
    )


def _start(flanges: list[FlangePlaces], s: StartPlaces, starts: str) -> str:
    count = len(s.rows)
    if s.initial_speed >= 0:
        speeds = f"    b[{s.speed}] = b[{s.initial_speed}]\n"
    else:
        speeds = f"    b[{s.speed}] = b[{flanges[0].w}] / blocks[{flanges[0].gear_w}]\n"
    offsets = "".join(
        f"    if blocks[{f.stiffness}] > 0.0:\n"
        f"        b[{f.offset}] += (b[{f.initial_torque}] - blocks[{f.gear_tau}])"
        f" / blocks[{f.stiffness}]\n"
        for f in flanges
    )
    torques = "".join(
        f"    r[{count + k}] = blocks[{f.gear_tau}] - b[{f.initial_torque}]\n"
        for k, f in enumerate(flanges)
    )
    as_set = "" if s.keeps_states else "        undeformed(b, t)\n"
    text = _KERNELS.format(
        unknowns=s.unknowns,
        sizes=s.sizes,
        rows=s.rows,
        derivatives=s.scratch,
        first=s.first,
        states=s.states,
        own=s.own,
        count=count,
        torques=torques,
        scratch=s.scratch + s.states,
        owner=s.owner,
        speed=s.speed,
        speeds=speeds,
        offsets=offsets,
        flank=s.flank,
        inner_step=s.inner_step,
        state_sizes=s.state_sizes,
        guess_count=len(s.guesses),
        forces="".join(f"            force += blocks[{i}]\n" for i in s.forces),
        step_start=s.step_start,
        start_mode=s.start_mode,
        as_set=as_set + "        twisted(b, t)\n",
        starts=starts,
        keep="".join(f"    b[{to}] = blocks[{at}]\n" for to, at in s.locals),
    )
    return f"\nGUESSES = {s.guesses!r}\n" + text

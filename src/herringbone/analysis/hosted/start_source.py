"""Source of the kernels that find the start of a gearbox for hosts.

**Equilibrium.** Unknown are the elastic coordinates, at rest, and the offsets; wanted is that no
elastic coordinate is accelerated, and that shafts carry their initial torques. The whole turns with
the start speed, and is accelerated by what is left over of the torques. The angle stays 0, and
angles that the host gives count as 0 meanwhile: beside 1e6 rad the search would begin far off, and
twists would lose their digits. Offsets take these angles up in the end. It is searched with the
teeth in contact on the drive flank, then on the coast flank. A shaft that hangs free in its
clearance has no stiffness by which it would be found, so that clearances are opened step by step,
from an equilibrium without.

**Periodic start.** From there the motion is searched that repeats itself every mesh period, while
the whole turns evenly; see `kernels.periodic.motion`.
"""

import math
from textwrap import indent

from herringbone.analysis.hosted.declaration import AS_SET, PERIODIC
from herringbone.analysis.hosted.start_places import FlangePlaces, StartPlaces

_KERNELS = """

from herringbone.kernels.periodic.motion import periodic_motion
from herringbone.kernels.periodic.places import Body
from herringbone.kernels.stepping.adaptive import LARGEST
from herringbone.kernels.stepping.newton import NOT_FOUND, SETTLED, newton_solver
from herringbone.kernels.spectral_radius import spectral_radius

UNKNOWNS = {unknowns!r}
SIZES = {sizes!r}
STATE_SIZES = {state_sizes!r}
COORDINATES = {coordinates!r}
COORDINATE_SIZES = {coordinate_sizes!r}
ROWS = {rows!r}
DERIVATIVES = {derivatives}
TRIALS = (0.0, 3.0, 15.0)
PART = 2.0
NO_VIBRATION = 2
TURN = {turn!r}


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
{untwisted}    refresh(b)
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


{opened}
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
        if opened(b, t) == SETTLED:
            force = 0.0
            scatter(blocks, b[{own}:{states}])
            propagate(blocks, t)
{forces}            if force * flank >= 0.0:
                return SETTLED
    return NOT_FOUND


body = Body.of(COORDINATES, COORDINATE_SIZES, {turning!r}, {free}, {states})
vibrate = periodic_motion(system_rhs, body, {scratch}, "{owner}")


@kernel
def vibrating(b: np.ndarray) -> int:
    teeth, w = (b[{first} + {teeth[0]}], b[{first} + {teeth[1]}]), b[{speed}]
    if w == 0.0 or teeth[0] == 0.0:
        return SETTLED
    degree = b[{degree}]
    b[{stepping}], b[{degree}] = 1.0, 0.0
    status = vibrate(b, TURN / abs(teeth[0] * w), teeth)
    b[{stepping}], b[{degree}] = 0.0, degree
    return status


@seldom
def settle(b: np.ndarray, t: float) -> int:
    blocks = b[{first}:]
    status = SETTLED
{taken}    b[{step_start}] = t
    if b[{start_mode}] == {as_set_mode}:
        b[{flank}] = 1.0
{as_set}    else:
        status = on_flank(b, t, 1.0)
        if status != SETTLED:
            status = on_flank(b, t, -1.0)
        if status != SETTLED:
            b[{flank}] = 1.0
            undeformed(b, t)
            twisted(b, t)
        elif b[{start_mode}] == {periodic} and vibrating(b) != SETTLED:
            status = NO_VIBRATION
    fastest = radius(b, t)
    b[{inner_step}] = LARGEST
    if fastest > 0.0:
        b[{inner_step}] = min(LARGEST, PART / fastest)
{given}    refresh(b)
    scatter(blocks, b[{own}:{states}])
{starts}{keep}    return status
"""

_OPENED = """
CLEARANCES = {clearances!r}
OPENINGS = 64


@kernel
def opened(b: np.ndarray, t: float) -> int:
    blocks, kept, any_open = b[{first}:], b[{kept}:], False
    for i in range({count}):
        kept[i] = blocks[CLEARANCES[i]]
        any_open = any_open or kept[i] > 0.0
    if not any_open:
        return search(b, t)
    for n in range(OPENINGS + 1):
        for i in range({count}):
            blocks[CLEARANCES[i]] = kept[i] * (n / OPENINGS)
        status = search(b, t)
        if status != SETTLED:
            break
    for i in range({count}):
        blocks[CLEARANCES[i]] = kept[i]
    return status

"""
_CLOSED = """
opened = search

"""


def start_source(flanges: list[FlangePlaces], s: StartPlaces, starts: str) -> str:
    """The kernels; `starts` calls the parts' start kernels on their blocks."""
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
    untwisted = "".join(f"    b[{f.offset}] = 0.0\n" for f in flanges)
    as_set = indent(untwisted, "    ") if s.keeps_states else "        undeformed(b, t)\n"
    turned = [f for f in flanges if f.phi >= 0]
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
        scratch=s.scratch + s.states + len(s.clearances),
        owner=s.owner,
        speed=s.speed,
        speeds=speeds,
        offsets=offsets,
        untwisted=untwisted,
        taken="".join(f"    angle_{f.phi}, b[{f.phi}] = b[{f.phi}], 0.0\n" for f in turned),
        given="".join(
            f"    b[{f.phi}] = angle_{f.phi}\n    b[{f.offset}] -= angle_{f.phi}\n" for f in turned
        ),
        flank=s.flank,
        inner_step=s.inner_step,
        state_sizes=s.state_sizes,
        coordinates=s.coordinates,
        coordinate_sizes=s.coordinate_sizes,
        turning=s.turning,
        free=s.free,
        teeth=s.teeth,
        stepping=s.stepping,
        degree=s.degree,
        turn=2.0 * math.pi,
        periodic=float(PERIODIC),
        as_set_mode=float(AS_SET),
        guess_count=len(s.guesses),
        opened=_opened(s),
        forces="".join(f"            force += blocks[{i}]\n" for i in s.forces),
        step_start=s.step_start,
        start_mode=s.start_mode,
        as_set=as_set + "        twisted(b, t)\n",
        starts=starts,
        keep="".join(f"    b[{to}] = blocks[{at}]\n" for to, at in s.locals),
    )
    return f"\nGUESSES = {s.guesses!r}\n" + text


def _opened(s: StartPlaces) -> str:
    """The search that opens clearances, which are kept behind the states' derivatives."""
    if not s.clearances:
        return _CLOSED
    count = len(s.clearances)
    return _OPENED.format(
        clearances=s.clearances, first=s.first, kept=s.scratch + s.states, count=count
    )

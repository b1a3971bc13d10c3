r"""Largest communication step of one FMU whose flange a host couples to an inertia.

A flange that takes torque is joined to the inertia J by the host's shaft of stiffness K and damping
D. The host evaluates the shaft at the communication points,

    tau = K (phi_J - phi) + D (w_J - w),

and until the next one both sides have the polynomial of order q through the last q + 1 torques: the
value is held (q = 0), or the FMU is given its derivatives. A shaft that is stepped in parallel with
its ends, as an FMU of its own by a master that steps all FMUs at once, answers one step late. A
flange that takes motion has its shaft inside the FMU; the inertia is at the flange, and takes the
polynomials of the FMU's torque. Inertia and FMU follow the polynomials exactly.

A step is stable if no motion grows faster than with a coupling that is exact: what a part does by
itself, or what its model misses of the free rotation, is no instability of the coupling.
"""

from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from scipy.linalg import expm

from herringbone.analysis.stability.growth import Growth, growth_of
from herringbone.analysis.stability.steps.step_scan import unstable_bands
from herringbone.analysis.stability.surrogates.identification import LinearModel
from herringbone.core.process.one_thread import one_blas_thread

ORDERS = (0, 1, 2)
SMALLEST, LARGEST = 1e-6, 1.0
"""Steps [s] at which the scan begins and ends."""
_SCAN = 1.1


@dataclass(frozen=True)
class Host:
    """What the host couples a flange to.

    Attributes:
        inertia: [kg.m2].
        stiffness: of the host's shaft [N.m/rad]; 0 where the shaft is inside the FMU.
        damping: [N.m.s/rad].
    """

    inertia: float
    stiffness: float = 0.0
    damping: float = 0.0


@dataclass(frozen=True)
class HostLimit:
    """Communication steps of one way to couple.

    Attributes:
        order: of the polynomials of the torque and the motion.
        parallel: the shaft answers one step late.
        unstable_bands: (from, to) [s], see `step_scan.unstable_bands`.
    """

    order: int
    parallel: bool
    unstable_bands: tuple[tuple[float, float], ...]

    @property
    def limit(self) -> float:
        """Largest step [s] below which everything examined is stable."""
        return self.unstable_bands[0][0] if self.unstable_bands else np.inf


def host_limits(flange: LinearModel, host: Host, *, takes_torque: bool) -> tuple[HostLimit, ...]:
    """Limits of all orders, in both schedules where there are two.

    Args:
        flange: from torque to angle and speed, or from these to torque; states of the FMU.
        host: what it is coupled to.
        takes_torque: which of both.
    """
    ways = [
        (q, parallel) for parallel in ((False, True) if takes_torque else (False,)) for q in ORDERS
    ]
    with one_blas_thread():
        return tuple(
            HostLimit(q, parallel, _bands(flange, host, q, parallel, takes_torque))
            for q, parallel in ways
        )


def _bands(
    flange: LinearModel, host: Host, order: int, parallel: bool, takes_torque: bool
) -> tuple[tuple[float, float], ...]:
    make = _shaft_outside if takes_torque else _shaft_inside
    own = _own_growth(flange, host, takes_torque)

    @cache
    def growth(h: float) -> Growth:
        found = growth_of(make(flange, host, h, order, parallel), h)
        less = np.exp(-own * h)
        return replace(found, radius=found.radius * less)

    return unstable_bands(growth, SMALLEST, LARGEST, _SCAN)


def _own_growth(flange: LinearModel, host: Host, takes_torque: bool) -> float:
    """Largest rate [1/s] of what grows with an exact coupling; 0 if nothing does."""
    a, b, c, d = flange.a, flange.b, flange.c, flange.d
    n = len(a)
    whole = np.zeros((n + 2, n + 2))
    whole[:n, :n], whole[n, n + 1] = a, 1.0
    gain = np.array([host.stiffness, host.damping])
    if takes_torque:
        # tau = gain (z_J - c x - d tau)
        loop = 1.0 + float(gain @ d[:, 0])
        row = np.concatenate([-gain @ c, gain]) / loop
        whole[:n] += np.outer(b[:, 0], row)
        whole[n + 1] -= row / host.inertia
    else:
        whole[:n, n:] += b
        whole[n + 1, :n] += c[0] / host.inertia
        whole[n + 1, n:] += d[0] / host.inertia
    return max(0.0, float(np.linalg.eigvals(whole).real.max()))


def _powers(a: np.ndarray, b: np.ndarray, h: float, order: int) -> list[np.ndarray]:
    """exp(a h), and responses of x at h to inputs (t/h)^k, k = 0 ... order, from rest."""
    n, p = b.shape
    size = n + p * (order + 1)
    whole = np.zeros((size, size))
    whole[:n, :n], whole[:n, n : n + p] = h * a, h * b
    for k in range(order):  # each integrates the one that follows
        at = n + k * p
        whole[at : at + p, at + p : at + 2 * p] = np.eye(p)
    found = expm(whole)[:n]
    factorials = np.cumprod([1.0, *range(1, order + 1)])
    return [
        found[:, :n],
        *(found[:, n + k * p : n + (k + 1) * p] * factorials[k] for k in range(order + 1)),
    ]


def _through(order: int) -> np.ndarray:
    """Coefficients of (t/h)^k by the last values, the newest first: (order + 1, order + 1)."""
    points = -np.arange(order + 1.0)
    return np.linalg.inv(np.vander(points, increasing=True))


def _shaft_outside(
    flange: LinearModel, host: Host, h: float, order: int, parallel: bool
) -> np.ndarray:
    """One step of [x, phi_J, w_J, torques: the newest first]."""
    n, q = len(flange.a), order + 1
    through, size = _through(order), n + 2 + order + 1
    a, *pushes = _powers(flange.a, flange.b, h, order)
    turn, *turns = _powers(
        np.array([[0.0, 1.0], [0.0, 0.0]]), np.array([[0.0], [-1.0 / host.inertia]]), h, order
    )
    step = np.zeros((size, size))
    step[:n, :n], step[n : n + 2, n : n + 2] = a, turn
    step[:n, n + 2 :] = np.hstack(pushes) @ through
    step[n : n + 2, n + 2 :] = np.hstack(turns) @ through
    step[n + 3 :, n + 2 : -1] = np.eye(q - 1)
    gain = np.array([host.stiffness, host.damping])
    at_end = through.sum(axis=0)  # the torque at the end of the step, by the newest ones
    if parallel:
        step[n + 2, :n], step[n + 2, n : n + 2] = -gain @ flange.c, gain
        step[n + 2, n + 2] -= float(gain @ flange.d[:, 0])
    else:
        step[n + 2] = gain @ step[n : n + 2] - gain @ flange.c @ step[:n]
        step[n + 2, n + 2 :] -= float(gain @ flange.d[:, 0]) * at_end
    return step


def _shaft_inside(
    flange: LinearModel, host: Host, h: float, order: int, parallel: bool
) -> np.ndarray:
    """One step of [x, motions: the newest first, torques: the newest first]."""
    del parallel
    n, q = len(flange.a), order + 1
    p = flange.b.shape[1]
    through, size = _through(order), n + 2 * q + q
    turn, *turns = _powers(
        np.array([[0.0, 1.0], [0.0, 0.0]]), np.array([[0.0], [1.0 / host.inertia]]), h, order
    )
    step = np.zeros((size, size))
    motions, torques = slice(n, n + 2), slice(n + 2 * q, size)
    step[motions, motions] = turn
    step[motions, torques] = np.hstack(turns) @ through
    step[n + 2 : n + 2 * q, n : n + 2 * q - 2] = np.eye(2 * (q - 1))
    step[n + 2 * q + 1 :, n + 2 * q : -1] = np.eye(q - 1)
    torque = np.zeros(size)
    if order == 0:
        held = flange.over(h)
        step[:n, :n], step[:n, n : n + p] = held.a, held.b
        torque[:n], torque[n : n + p] = held.c[0], held.d[0]
    else:
        a, *pushes = _powers(flange.a, flange.b, h, order)
        step[:n, :n] = a
        by_value = np.kron(through, np.eye(p))
        step[:n, n : n + 2 * q] = np.hstack(pushes) @ by_value
        torque = flange.c[0] @ step[:n]
        torque[n : n + 2 * q] += flange.d[0] @ np.kron(through.sum(axis=0), np.eye(p))
    step[n + 2 * q] = torque
    return step

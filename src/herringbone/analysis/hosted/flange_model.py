"""Linear equations of a gearbox for hosts, as one of its flanges feels them."""

import numpy as np
from scipy.linalg import schur

from herringbone.analysis.hosted.boundary import HostFlange
from herringbone.analysis.hosted.declaration import EQUILIBRIUM, START_MODE
from herringbone.analysis.stability.surrogates.identification import LinearModel
from herringbone.analysis.twin.composite import Composite
from herringbone.core import ParameterError
from herringbone.core.declaring.hosting import Given
from herringbone.core.declaring.roles import GEARS, Quantity
from herringbone.cosim.signature.rotation import InputRule

_SMALL = {"m": 1e-9, "m/s": 1e-6, "rad": 1e-8, "rad/s": 1e-5}
_SMALL_VECTOR = 1e-9
_FREE = 1.0
"""Eigenvalues [1/s] of free rotation are smaller."""
_PAIRS = 14
_PHASES = 8
"""Of a mesh period."""


def started(composite: Composite) -> np.ndarray:
    """The block in its equilibrium."""
    component = composite.component
    d = component.declaration
    block = np.zeros(d.size)
    for v in d.variables:
        block[d.index[v.name]] = v.start
    block[d.index[START_MODE]] = EQUILIBRIUM
    component.load(block, {t.name: composite.resources[t.start] for t in d.texts})
    if component.hosting is None or component.hosting.settle(block, 0.0):
        raise ParameterError(f"{d.name}: no equilibrium at the start, so that no step is known")
    return block


def averaged(composite: Composite, block: np.ndarray, flange: HostFlange) -> LinearModel:
    """The mean of the linear models over a mesh period, while everything turns."""
    component, names = composite.component, composite.component.declaration
    rates = np.zeros(names.state_count)
    component.kernels.rhs(block, 0.0, rates)
    rotating = [v for v in names.states if v.steady == "rotating"]
    turning = {names.index[v.name]: rates[names.index[v.name]] for v in rotating}
    for which in component.hosting.runs_on if component.hosting else ():
        turning[names.index[which.input]] = block[names.index[which.rate]]
    pinion = next(v.name for v in rotating if f"der({v.name})" in names.index)
    (teeth,) = (v for v in names.offered(Quantity.NUMBER_OF_TEETH) if v.place == GEARS[0])
    speed = block[names.index[teeth.name]] * rates[names.index[pinion]]
    found = []
    for k in range(_PHASES if speed else 1):
        moved = block.copy()
        for place, rate in turning.items():
            moved[place] += rate * 2.0 * np.pi * k / (_PHASES * speed) if k else 0.0
        found.append(_linear(composite, moved, flange))
    a, b, c, d = (np.mean([getattr(m, name) for m in found], axis=0) for name in "abcd")
    return LinearModel(a, b, c, d, found[0].given, found[0].rates)


def _linear(composite: Composite, block: np.ndarray, flange: HostFlange) -> LinearModel:
    """From what the host gives at a flange to what it gets; the speed alone is like a motion."""
    kernels, d = composite.component.kernels, composite.component.declaration
    motion = [f"{flange.name}.phi", f"{flange.name}.w"]
    torque = [f"{flange.name}.tau"]
    inputs, outputs = (torque, motion) if flange.given is Given.TORQUE else (motion, torque)
    places = [d.index.get(name, d.index.get(f"{flange.name}.angle", 0)) for name in inputs]
    wanted = [d.index[name] for name in outputs]
    small = [_SMALL.get(v.unit, 1.0) for v in d.states] + [_SMALL_VECTOR] * d.hidden_states

    def answers() -> np.ndarray:
        dx = np.zeros(d.state_count)
        kernels.rhs(block, 0.0, dx)
        kernels.out(block, 0.0)
        return np.concatenate([dx, block[wanted]])

    def slope(place: int, size: float) -> np.ndarray:
        kept, found = block[place], []
        for sign in (1.0, -1.0):
            block[place] = kept + sign * size
            found.append(answers())
        block[place] = kept
        return (found[0] - found[1]) / (2.0 * size)

    whole = np.array([slope(i, small[i]) for i in range(d.state_count)]).T
    given = np.array([slope(p, 1e-6 if len(places) > 1 else 1.0) for p in places]).T
    n = d.state_count
    own = {i for i, v in enumerate(d.states) if v.unit == "N.m.s"} | set(places)
    live = [i for i in range(n) if i not in own and (whole[i, :n].any() or whole[:n, i].any())]
    runs_on = len(places) > 1
    return LinearModel(
        whole[np.ix_(live, live)],
        given[live],
        whole[n:][:, live],
        given[n:],
        (InputRule.START,) * len(places),
        (1, -1) if runs_on else (-1,),
    )


def reduced(model: LinearModel) -> LinearModel:
    """The model with its free rotation and the motions that count most at the flange."""
    values, right = np.linalg.eig(model.a)
    left = np.linalg.pinv(right)  # free rotation has one vector only; its part is not used
    free = np.abs(values) < _FREE
    basis, dual = _rigid(model.a), _rigid(model.a.T)
    dual = dual @ np.linalg.inv(basis.T @ dual)
    b_of, c_of = left @ model.b, model.c @ right
    weight = np.linalg.norm(b_of, axis=1) * np.linalg.norm(c_of, axis=0)
    weight /= np.maximum(np.abs(values), 1e-9) * np.sqrt(np.maximum(-values.real, 1.0))
    order = [k for k in np.argsort(-weight) if not free[k] and values[k].imag >= 0.0]
    columns, rows = [basis], [dual.T]
    d = model.d.astype(complex)
    for rank, k in enumerate(order):
        twice = 2.0 if values[k].imag > 0.0 else 1.0
        if rank < _PAIRS:
            columns.append(_real(right[:, k], twice))
            rows.append(_real(left[k], twice, dual=True).T)
        else:  # it follows at once
            d = d + np.real(twice * np.outer(c_of[:, k], b_of[k]) / -values[k])
    v, w = np.hstack(columns), np.vstack(rows)
    return LinearModel(w @ model.a @ v, w @ model.b, model.c @ v, d.real, model.given, model.rates)


def _rigid(a: np.ndarray) -> np.ndarray:
    """Basis of the motions with small eigenvalues."""
    _, vectors, count = schur(a, sort=lambda re, im: re * re + im * im < _FREE**2)
    return vectors[:, :count]


def _real(vector: np.ndarray, twice: float, *, dual: bool = False) -> np.ndarray:
    """Real basis (n, 1 or 2) of a pair of conjugate vectors, or of its dual."""
    if twice == 1.0:
        return vector.real[:, None]
    pair = np.stack([vector.real, vector.imag], axis=1)
    return pair * np.array([2.0, -2.0]) if dual else pair

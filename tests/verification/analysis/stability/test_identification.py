"""Linear models from answers to pulses: known systems come back, at steps of any length."""

import numpy as np
import pytest
from scipy.linalg import expm

from herringbone.analysis.stability.surrogates.identification import (
    Step,
    blocks,
    in_continuous_time,
    realised,
)
from herringbone.analysis.stability.surrogates.surrogate import PROMISED, Surrogate
from herringbone.cosim.fmu.opening import many_of
from herringbone.cosim.signature import Laboratory
from herringbone.cosim.signature.rotation import InputRule
from herringbone.running.foreign.start_inputs import start_inputs
from herringbone.running.foreign.trials import signature_of

LAG, INERTIA, STIFFNESS, DAMPING = 2e-3, 0.12, 8e4, 15.0
"""Of the e-drive in `tests/fmus/kinds`."""
A = np.array([
    [-1.0 / LAG, 0.0, 0.0],
    [0.0, 0.0, 1.0],
    [1.0 / INERTIA, -STIFFNESS / INERTIA, -DAMPING / INERTIA],
])  # fmt: skip
B = np.array([[1.0 / LAG, 0.0, 0.0], [0.0] * 3, [0.0, STIFFNESS / INERTIA, DAMPING / INERTIA]])
C = np.array([[0.0, STIFFNESS, DAMPING], [0.0, 0.0, 1.0]])
D = np.array([[0.0, -STIFFNESS, -DAMPING], [0.0] * 3])
ROUNDING = 1e-7
"""Of what two logarithms and a Hankel matrix of condition 1e6 leave of 1e-16."""


def step_of(h, rule):
    """One step: held inputs, of which the angle moves on with the speed by a rule."""
    n = 400
    a = expm(h * A)
    times = (np.arange(n) + 0.5) * h / n
    b, d = np.zeros((3, 3)), D.copy()
    # Midpoints of exact pieces: inputs that are linear in time are met to the second order.
    piece = np.linalg.solve(A, expm(h / n * A) - np.eye(3))
    for t in times:
        moved = {InputRule.MEAN: 0.0, InputRule.START: t, InputRule.END: t - h}[rule]
        held = np.eye(3)
        held[1, 2] = moved
        b += expm((h - t - 0.5 * h / n) * A) @ piece @ B @ held
    if rule is InputRule.START:
        d[:, 2] += h * D[:, 1]
    return a, b, C @ a, C @ b + d


def markov_of(a, b, c, d, steps):
    found, power = [d], np.eye(len(a))
    for _ in range(steps - 1):
        found.append(c @ power @ b)
        power = a @ power
    return np.array(found)


@pytest.mark.parametrize("rule", InputRule)
@pytest.mark.parametrize("h", [2e-5, 1.3e-4, 1.7e-3])
def test_step_of_another_length(rule, h):
    """Trials of 1e-4 s; the drive's angle is held, runs on, or runs up."""
    base = 1e-4
    outputs, inputs = D.shape
    scale_y, scale_u = np.array([1.0, 1e-4]), np.array([1.0, 1e-5, 1e-3])
    a, b, c, d = step_of(base, rule)
    scaled = a, b * scale_u, c / scale_y[:, None], d * scale_u / scale_y[:, None]
    found = realised(markov_of(*scaled, 1 + sum(blocks(inputs, outputs)))).reduced(3)
    given, rates = (
        (InputRule.MEAN, rule, InputRule.MEAN),
        (-1, 2 if rule is not InputRule.MEAN else -1, -1),
    )
    model = in_continuous_time(
        type(found)(
            found.a, found.b / scale_u, found.c * scale_y[:, None],
            found.d * scale_y[:, None] / scale_u,
        ),
        base, given, rates,
    )  # fmt: skip
    assert model is not None
    assert np.sort_complex(np.linalg.eigvals(model.a)) == pytest.approx(
        np.sort_complex(np.linalg.eigvals(A)), rel=ROUNDING
    )
    step, true = model.over(h), step_of(h, rule)
    drive = np.random.default_rng(3).uniform(-1.0, 1.0, (30, inputs)) * scale_u
    expected = type(step)(*true).answers(drive)
    quadrature = 1e-5  # of the midpoints, (h w / 400)^2 / 24 = 5e-7, and their sums
    tolerance = quadrature * np.abs(expected).max(axis=0)
    assert (np.abs(step.answers(drive) - expected) <= tolerance).all()


def test_a_delay_has_no_continuous_time():
    """Two steps late: eigenvalues 0."""
    markov = np.zeros((81, 1, 1))
    markov[2] = 1.0
    found = realised(markov)
    assert len(found.a) == 2
    assert in_continuous_time(found, 1e-3, (InputRule.MEAN,), (-1,)) is None


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize(("size", "known"), [(100.0, True), (1e4, False)])
def test_a_step_whose_logarithm_is_lost(size, known):
    """Far from normal, the logarithm errs by 2e-9 and by 6 % of the step; nothing is printed."""
    a = np.diag(np.linspace(0.9, 0.1, 5)) + size * np.eye(5, k=1)
    step = Step(a, np.eye(5, 1), np.eye(1, 5), np.zeros((1, 1)))
    model = in_continuous_time(step, 0.1, (InputRule.MEAN,), (-1,))
    assert (model is not None) is known
    if model is not None:
        assert np.abs(expm(0.1 * model.a) - a).max() < 1e-8 * size


def surrogate_of(file, step, used=None):
    with many_of(file.stem, file) as make:
        signature = signature_of(make(), make, step)
        inputs = list(signature.inputs)
        start = start_inputs(make(), inputs)
        with Laboratory(make, inputs, used or signature.outputs, start, step) as lab:
            surrogate = Surrogate(lab, signature, make().variables)
            residuals = {h: surrogate.residual(h) for h in (1e-5, 1e-4, 1e-3)}
    return surrogate, residuals


@pytest.mark.parametrize(
    ("name", "order", "pole"),
    [("EDrive", 3, 816.0), ("c_e_drive", 3, 816.0), ("oscillator_mass", 2, 0.0)],
)
def test_foreign_parts(kinds, name, order, pole):
    """Orders and poles of what the FMUs are; fresh trials of other lengths are met."""
    surrogate, residuals = surrogate_of(kinds / f"{name}.fmu", 1e-4, None)
    assert surrogate.order == order
    assert max(residuals.values()) < 1e-5
    assert np.abs(np.linalg.eigvals(surrogate.model.a)).max() == pytest.approx(
        pole, rel=2e-3, abs=1e-3
    )


def test_nothing_is_promised_of_a_sampled_part(kinds):
    """A controller with a clock of its own: no linear system of these steps."""
    surrogate, residuals = surrogate_of(kinds / "c_ecu_task.fmu", 1e-4)
    assert surrogate.model is None or max(residuals.values()) > PROMISED

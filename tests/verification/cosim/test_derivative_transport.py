"""Signals as FMI derivatives instead of nodes: order on exact subsystems, accuracy on the rig.

A polynomial that is given by its derivatives is the one that is given by its nodes: jacobi and
gauss_seidel differ by rounding only. The iterated algorithms also take outputs inside the step,
which are Hermite cubics then: their order is 4 at most. Inputs up to order q alone leave 2 q + 2.
"""

from contextlib import closing

import numpy as np
import pytest
from support.derivatives import DerivativeMass, without_nodes
from support.parts.fakes import ERROR
from support.parts.running import columns, open_in_process, slope
from support.parts.two_masses import MOTION, TwoMass
from support.rig.beside_twin import BesideTwin

from herringbone.core import FmuError, OutcomeKind
from herringbone.cosim.algorithms import LI, FixedPoint, GaussSeidel, Jacobi, Predict
from herringbone.cosim.fmu.opening import open_fmu

T_END = 4.0
SHORT, LONG = (0.04, 0.02, 0.01, 0.005), (0.2, 0.1, 0.05)
"""h w, for one pass and for iteration: errors far above rounding."""
NODES_HIDDEN = "left has no signal nodes; "


def run(algorithm, h, *, zeta=0.0, t_end=T_END, **more):
    recording = TwoMass(zeta=zeta).run(algorithm, h, t_end, **({"kind": DerivativeMass} | more))
    assert recording.outcome.completed
    return recording


def order(algorithm, steps, *, zeta=0.0, **more):
    errors = []
    for h in steps:
        recording = run(algorithm, h, zeta=zeta, **more)
        exact = TwoMass(zeta=zeta).exact(recording.time)
        errors.append(np.linalg.norm(columns(recording, MOTION) - exact) / np.linalg.norm(exact))
    return slope(steps, errors)


# -- order --------------------------------------------------------------------------------------


@pytest.mark.parametrize("taken", [1, 4])
@pytest.mark.parametrize("q", [1, 2])
def test_jacobi_keeps_its_order(q, taken):
    """Also where a part takes less than the signal has: the moments of the force are right."""
    assert order(Jacobi(order=q), SHORT, order=taken) == pytest.approx(q + 1, abs=0.15)


@pytest.mark.parametrize(
    ("algorithm", "more"),
    [
        (Jacobi(order=1), {}),
        (Jacobi(order=2), {}),
        (GaussSeidel(order=2), {}),
        (Predict(), {"acceleration": True}),
        (LI(degree=1), {}),
    ],
    ids=str,
)
def test_derivatives_are_the_same_polynomial_as_nodes(algorithm, more):
    """Without outputs inside the step the results differ by rounding, here of 40 steps."""
    one = run(algorithm, 0.1, zeta=0.1, **more)
    other = TwoMass(zeta=0.1).run(algorithm, 0.1, T_END, **more)
    difference = columns(one, MOTION) - columns(other, MOTION)
    assert np.abs(difference).max() < 1e-12
    kept = algorithm.convergence_order
    assert one.notes[0].startswith(NODES_HIDDEN + "its inputs go as FMI derivatives up to order")
    assert one.notes[0].endswith(f"the coupling keeps order {kept} in the step")


@pytest.mark.parametrize("algorithm", [LI(degree=2), LI(degree=3), LI(degree=4)], ids=str)
def test_li_is_of_fourth_order(algorithm):
    assert order(algorithm, LONG, zeta=0.1) == pytest.approx(4.0, abs=0.15)


def test_fixed_point_is_of_fourth_order():
    assert order(FixedPoint(degree=3, sweeps=12), LONG, zeta=0.1) == pytest.approx(4.0, abs=0.15)


def test_first_derivatives_alone_leave_order_4():
    assert order(LI(degree=3), LONG, zeta=0.1, order=1) == pytest.approx(4.0, abs=0.15)


@pytest.mark.parametrize("zeta", [0.0, 0.1])
@pytest.mark.parametrize("rates", [False, "refused"])
def test_without_rates_it_is_of_third_order(rates, zeta):
    found = order(LI(degree=3), LONG, zeta=zeta, rates=rates)
    assert found == pytest.approx(3.0, abs=0.15)


def test_adaptive_li_takes_derivatives():
    """Within the tolerance, and by nearly as few steps as with nodes."""
    algorithm, problem = LI(degree=3, tolerance=1e-4), TwoMass(zeta=0.05)
    found = problem.run(algorithm, 1.0, 20.0, kind=DerivativeMass)
    wanted = problem.run(algorithm, 1.0, 20.0)
    exact = problem.exact(found.time)
    assert np.linalg.norm(columns(found, MOTION) - exact) < 1e-3 * np.linalg.norm(exact)
    assert found.macro_steps < 1.2 * wanted.macro_steps


# -- what is reported ---------------------------------------------------------------------------

LOSSES = [
    ({"order": 2}, "input derivatives of order 3", "up to order 2", "keeps order 4"),
    ({"order": 1}, "input derivatives of order 3", "up to order 1", "keeps order 4"),
    ({"order": 0}, "input derivatives of order 3", "inputs are held", "falls from order 4 to 2"),
    ({"rates": "refused"}, "output derivatives", "past values", "falls from order 4 to 3"),
]


@pytest.mark.parametrize("status", [2, ERROR])
@pytest.mark.parametrize(("more", "refused", "way", "cost"), LOSSES)
def test_refusal_is_a_reported_downgrade(more, refused, way, cost, status):
    (note,) = run(LI(degree=3), 0.1, status=status, **more).notes
    if "order" not in more:
        status = 2
    assert note.startswith(NODES_HIDDEN)
    assert f"it declares {refused} but refuses them (FMI status {status})" in note
    assert way in note and cost in note


def test_held_after_refusal_is_the_same_as_held():
    one = run(LI(degree=3), 0.1, order=0)
    other = TwoMass().run(LI(degree=3), 0.1, T_END, kind=HeldMass)
    assert np.array_equal(columns(one, MOTION), columns(other, MOTION))


class HeldMass(DerivativeMass):
    """A mass that declares no derivatives."""

    @property
    def addresses(self):
        return super().addresses._replace(set_derivatives=0, get_derivatives=0)


def test_jacobi_falls_to_hold():
    (note,) = run(Jacobi(order=2), 0.1, order=0).notes
    assert note.endswith("its inputs are held over a step; the coupling falls from order 3 to 1 in "
                         "the step")  # fmt: skip


def test_fatal_refusal_is_one_line():
    with pytest.raises(FmuError, match=r"^left fails for good at input derivatives of order 3"):
        run(LI(degree=3), 0.1, order=0, status=4)


def test_refusal_in_the_run_is_an_outcome():
    """A part that took the derivatives at first, and no longer does."""

    def change_of_mind(part, t):
        part.order = 0 if t > 1.0 else part.order
        return 0

    recording = TwoMass().run(
        LI(degree=3), 0.1, T_END, kind=DerivativeMass, misbehave=change_of_mind
    )
    assert recording.outcome.kind is OutcomeKind.PART_FAILED
    assert recording.outcome.culprit == "left"
    assert recording.outcome.time == pytest.approx(1.0, abs=0.11)
    assert np.isfinite(recording.values).all()


# -- FMUs ---------------------------------------------------------------------------------------

HOUSING = "gearbox.modal_housing"
DECLARES_NOTHING = {"canInterpolateInputs": "false", "maxOutputDerivativeOrder": "0"}


@pytest.fixture(scope="module")
def housings(native_fmus, tmp_path_factory):
    """The housing with nodes; with derivatives only; with neither."""
    original = native_fmus["modal_housing"]
    folders = [tmp_path_factory.mktemp(name) for name in ("derivatives", "hold")]
    return {
        "nodes": original,
        "derivatives": without_nodes(original, folders[0]),
        "hold": without_nodes(original, folders[1], **DECLARES_NOTHING),
    }


class Rig(BesideTwin):
    """The scene loaded with a housing from a file, beside its twin."""

    def __init__(self, housings):
        super().__init__("loaded", 0.01)
        self.housings = housings

    def with_housing(self, transport, algorithm, h):
        """Errors of bearing forces and seat velocities, and the housing's notes."""
        parts = open_in_process(self.system)
        at = [p.name for p in parts].index(HOUSING)
        parts[at] = housing = open_fmu(HOUSING, self.housings[transport])
        with closing(housing):
            for name, value in self.system.parts[at].values.items():
                housing.set(name, value)
            error, recording = self.run(algorithm, h, parts)
        return error, [n for n in recording.notes if n.startswith(HOUSING)]


@pytest.fixture(scope="module")
def loaded(housings):
    return Rig(housings)


@pytest.mark.slow
def test_li_on_the_rig(loaded):
    """Bearing forces and seat velocities: 1e-5, 2e-5 with nodes; 9e-5, 1.2e-4 with derivatives;
    3.5e-3, 3.7e-2 held. The step is a fifth of the shortest period of the housing's residual modes.
    """
    found = {
        t: loaded.with_housing(t, LI(degree=3), 40e-6)[0] for t in ("nodes", "derivatives", "hold")
    }
    assert (found["derivatives"] <= found["hold"] / 10.0).all()
    assert (found["derivatives"] <= 5e-4).all()
    assert (found["nodes"] <= found["derivatives"]).all()


@pytest.mark.parametrize("q", [1, 2])
def test_jacobi_on_the_rig(loaded, q):
    """The same polynomial; what differs is rounding, which 1000 steps of the bearings amplify."""
    nodes, derivatives = (
        loaded.with_housing(t, Jacobi(order=q), 10e-6)[0] for t in ("nodes", "derivatives")
    )
    assert derivatives == pytest.approx(nodes, rel=1e-6)


def test_the_housing_s_transport_is_reported(loaded):
    notes = {t: loaded.with_housing(t, LI(degree=3), 40e-6)[1] for t in ("derivatives", "hold")}
    assert notes["derivatives"] == [
        f"{HOUSING} has no signal nodes; its inputs go as FMI derivatives up to order 3; its "
        "outputs are cubics through values and FMI derivatives; the coupling keeps order 4 in the "
        "step"
    ]
    assert len(notes["hold"]) == 1 and "second order in the step" in notes["hold"][0]


def test_fmu_that_refuses_what_it_declares(loaded, python_fmus, tmp_path):
    """The runtime of Python FMUs has no derivatives; its flags are set here all the same."""
    loaded.housings["liar"] = without_nodes(
        python_fmus["modal_housing"],
        tmp_path,
        canInterpolateInputs="true",
        maxOutputDerivativeOrder="1",
    )
    error, (note,) = loaded.with_housing("liar", LI(degree=3), 40e-6)
    held, _ = loaded.with_housing("hold", LI(degree=3), 40e-6)
    assert "it declares input derivatives of order 3 but refuses them" in note
    assert note.endswith(
        "its inputs are held over a step; its outputs are interpolated through past values; the "
        "coupling falls from order 4 to 2 in the step"
    )
    assert error == pytest.approx(held, rel=1e-6)

"""A surrogate behind FMI functions: its answers, and what states are to a macro step."""

from types import SimpleNamespace

import numpy as np
import pytest

from herringbone.analysis.stability.surrogates.identification import LinearModel
from herringbone.analysis.stability.surrogates.surrogate_part import SurrogatePart
from herringbone.core.part import PartVariable
from herringbone.cosim.loops.calls import do_step
from herringbone.cosim.signature.rotation import InputRule

STATES, INPUTS, OUTPUTS = 7, 2, 3
EQUAL, UNLIKE = [1e-3] * 5, [1e-3, 1e-3, 4e-4, 2e-3]
ROUNDING = 1e-12
"""Of five products of matrices with entries of about 1."""


def surrogate_part(random):
    """A part of random matrices, and their steps."""
    model = LinearModel(
        100.0 * random.standard_normal((STATES, STATES)),
        random.standard_normal((STATES, INPUTS)),
        random.standard_normal((OUTPUTS, STATES)),
        random.standard_normal((OUTPUTS, INPUTS)),
        (InputRule.MEAN,) * INPUTS,
        (-1,) * INPUTS,
    )
    inputs, outputs = [f"u{k}" for k in range(INPUTS)], [f"y{k}" for k in range(OUTPUTS)]
    surrogate = SimpleNamespace(
        over=model.over, orders=0, rated=False, width=(INPUTS, OUTPUTS),
        inputs=inputs, outputs=outputs,
        start=random.standard_normal(INPUTS), start_outputs=random.standard_normal(OUTPUTS),
    )  # fmt: skip
    kinds = {"input": inputs, "output": outputs}
    variables = {n: PartVariable(n, 0, kind) for kind, names in kinds.items() for n in names}
    part = SimpleNamespace(
        name="box", has_states=True, once=False, one_step=False, variables=variables,
        addresses=SimpleNamespace(can_restore=True),
    )  # fmt: skip
    return SurrogatePart(part, surrogate), surrogate


def stepped(part, inputs, lengths):
    """Outputs after each step; lengths are learnt where they are refused."""
    found, addresses = [], part.addresses
    for u, h in zip(inputs, lengths, strict=True):
        for name, value in zip(("u0", "u1"), u, strict=True):
            part.set(name, value)
        while do_step(addresses.do_step, addresses.component, 0.0, h) != 0:
            assert part.learn()
        found.append(part.get([f"y{k}" for k in range(OUTPUTS)]))
    return np.array(found)


@pytest.mark.parametrize("lengths", [EQUAL, UNLIKE], ids=["equal", "unlike"])
def test_steps_are_those_of_the_model(lengths):
    """By its answers, from states and inputs; and its states at the end by the inputs held."""
    random = np.random.default_rng(5)
    part, surrogate = surrogate_part(random)
    inputs = random.standard_normal((len(lengths), INPUTS))
    state = random.standard_normal(STATES)
    start = part.values.copy()
    stepped(part, inputs, lengths)
    macro = part.macro_step()
    assert macro.lengths == tuple(lengths)
    part.values[:] = start
    part.values[: len(lengths) * OUTPUTS] = macro.answers @ state
    found = stepped(part, inputs, lengths)
    x, expected = state, []
    for u, h in zip(inputs - surrogate.start, lengths, strict=True):
        step = surrogate.over(h)
        expected.append(surrogate.start_outputs + step.c @ x + step.d @ u)
        x = step.a @ x + step.b @ u
    assert found == pytest.approx(np.array(expected), rel=ROUNDING, abs=ROUNDING)
    held = part.values[part.held][: len(lengths) * INPUTS]
    assert macro.states @ state + macro.held @ held == pytest.approx(x, rel=1e-10, abs=ROUNDING)


def test_a_part_takes_so_many_steps_only():
    """The thirteenth is refused, and cannot be learnt."""
    part, _ = surrogate_part(np.random.default_rng(6))
    stepped(part, np.zeros((12, INPUTS)), [1e-3] * 12)
    addresses = part.addresses
    assert do_step(addresses.do_step, addresses.component, 0.0, 1e-3) != 0
    assert not part.learn()

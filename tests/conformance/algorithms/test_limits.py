"""Every algorithm's predicted limit is that of runs, and the energy is watched on both sides."""

import pytest
from support.algorithms import ZETAS, check_energy, check_limit, every, keeps_its_step


@pytest.mark.parametrize("zeta", ZETAS)
@every(keeps_its_step)
def test_predicted_limit_is_the_simulated_one(algorithm, zeta):
    check_limit(algorithm, zeta)


@pytest.mark.parametrize("zeta", ZETAS)
@every()
def test_energy_is_flagged_beyond_the_limit_and_silent_below(algorithm, zeta):
    check_energy(algorithm, zeta)

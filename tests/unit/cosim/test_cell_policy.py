"""Which FMUs run in cells, in this process and in another one."""

import pickle

from herringbone.cosim.cell.policy import Policy, elsewhere, foreign_fmu_policy, policy


def told() -> tuple[bool, float, int | None, int | None]:
    """What decides here."""
    found: Policy = policy()
    return found.in_process, found.deadline, found.longest_trial, found.most_trial_steps


def test_what_is_done_elsewhere_is_done_under_the_policy_of_here():
    with foreign_fmu_policy(
        in_process=True, deadline=7.0, longest_trial=800, most_trial_steps=9000
    ):
        sent = pickle.dumps(elsewhere(told))
    assert pickle.loads(sent)() == (True, 7.0, 800, 9000)
    assert told() != (True, 7.0, 800, 9000)

"""Signal over a bus: y(t) = u(t - 5 ms). The input counts as constant during a step."""

from collections import deque

from pythonfmu import Fmi2Causality, Fmi2Slave, Real

LATENCY = 5e-3  # s
SLACK = 1e-9  # s, against rounding of the times


class BusDelay(Fmi2Slave):
    description = "transport delay"

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.u = 0.0
        self.y = 0.0
        self.sent = deque([(float("-inf"), 0.0)])  # time from which a value holds, value
        self.register_variable(Real("u", causality=Fmi2Causality.input))
        self.register_variable(Real("y", causality=Fmi2Causality.output))

    def do_step(self, current_time, step_size):
        self.sent.append((current_time, self.u))
        wanted = current_time + step_size - LATENCY + SLACK
        while len(self.sent) > 1 and self.sent[1][0] <= wanted:
            self.sent.popleft()
        self.y = self.sent[0][1]
        return True

    def _get_fmu_state(self):
        return {**super()._get_fmu_state(), "sent": list(self.sent)}

    def _set_fmu_state(self, state):
        super()._set_fmu_state(state)
        self.sent = deque(tuple(pair) for pair in state["sent"])

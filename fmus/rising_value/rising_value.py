"""pythonfmu script of the component rising_value."""

from herringbone.fmi.python.slave import ComponentSlave


class rising_value(ComponentSlave):
    """The methods stand here because pythonfmu needs two functions in the script itself."""

    def do_step(self, current_time: float, step_size: float) -> bool:
        """Advance by `step_size` [s]; False discards the step."""
        return self.advance(current_time, step_size)

    def terminate(self) -> None:
        """End the run."""
        self.end()

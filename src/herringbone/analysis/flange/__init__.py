"""What every part with flanges must do: motors, loads and couplings, whoever wrote them."""

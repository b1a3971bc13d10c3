"""Drop-in: the gearbox in a drivetrain of your own, written as a system.toml."""

import tempfile
from pathlib import Path

import herringbone as hb

SYSTEM = """
name = "winch"
description = "motor - coupling - gearbox - soft coupling - drum"
connections = [
  ["bench_controller.speed_setpoint", "motor.speed_setpoint"],
  ["bench_controller.torque_setpoint", "drum.torque_setpoint"],
  ["motor.flange", "coupling.flange_a"],
  ["gearbox.pinion", "coupling.flange_b"],
  ["gearbox.wheel", "rope_side.flange_a"],
  ["drum.flange", "rope_side.flange_b"],
]
[parts]
bench_controller = { component = "bench_controller" }
motor = { component = "drive_motor", set = { inertia = 0.2 } }
coupling = { component = "shaft_coupling" }
gearbox = { system = "gearbox" }
rope_side = { component = "shaft_coupling", set = { stiffness = 2e4, damping = 20.0 } }
drum = { component = "load_motor", set = { inertia = 8.0 } }
"""


def main(t_end: float = 0.05) -> float:
    """Mean torque at the drum [N m]."""
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "system.toml").write_text(SYSTEM, encoding="utf-8")
        result = hb.run(folder, t_end=t_end)
    torque = float(result.data["rope_side.torque"].mean())
    print(f"mean torque at the drum: {torque:.1f} N m")
    return torque


if __name__ == "__main__":
    main()

"""The whole gearbox as one FMU in a loop of one's own: motor and load are three lines of Python."""

import tempfile
from pathlib import Path

from fmpy import extract, instantiate_fmu, read_model_description
from fmpy.model_description import ModelDescription

from herringbone.running.exporting.system_fmu import export_fmu

STEP = 2e-5
INERTIA, STIFFNESS, DAMPING = (0.1, 2.0), (6e4, 3e5), (5.0, 50.0)  # at pinion and wheel
TORQUE = (200.0, -600.0)  # of motor and load [N m]; they balance


def reference_of(model: ModelDescription, name: str) -> int:
    """Value reference of a port's variable."""
    return next(v.valueReference for v in model.modelVariables if v.name.endswith(name))


def main(t_end: float = 0.02) -> float:
    """Mean torque of the shaft between motor and pinion [N m]."""
    with tempfile.TemporaryDirectory() as folder:
        file = export_fmu("gearbox", Path(folder) / "gearbox.fmu")
        model = read_model_description(file)
        gearbox = instantiate_fmu(extract(file), model, "CoSimulation")
    ports = {
        quantity: [reference_of(model, f"{gear}.{quantity}") for gear in ("pinion", "wheel")]
        for quantity in ("tau", "phi", "w")
    }
    gearbox.enterInitializationMode()
    gearbox.setReal(ports["tau"], TORQUE)
    gearbox.exitInitializationMode()
    angle, speed = gearbox.getReal(ports["phi"]), gearbox.getReal(ports["w"])
    rotor = [a + t / k for a, t, k in zip(angle, TORQUE, STIFFNESS, strict=True)]  # twisted
    turning, shaft, passed = list(speed), list(TORQUE), []
    for n in range(round(t_end / STEP)):
        for i in range(2):  # rotors move on, under the torques of their shafts
            turning[i] += STEP * (TORQUE[i] - shaft[i]) / INERTIA[i]
            rotor[i] += STEP * turning[i]
        gearbox.setReal(ports["tau"], shaft)
        gearbox.doStep(n * STEP, STEP)
        angle, speed = gearbox.getReal(ports["phi"]), gearbox.getReal(ports["w"])
        for i in range(2):
            twist, rate = rotor[i] - angle[i], turning[i] - speed[i]
            shaft[i] = STIFFNESS[i] * twist + DAMPING[i] * rate
        passed.append(shaft[0])
    gearbox.terminate()
    return sum(passed) / len(passed)


if __name__ == "__main__":
    print(f"torque at the pinion: {main():.2f} N m")

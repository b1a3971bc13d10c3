"""The e-motor and the vehicle of `tests/fmus/kinds` at speed, behind a gearbox in steady rotation.

These FMUs start at rest and have no parameters for it: copies begin with other numbers. Shafts are
twisted by the torque that they pass on, so that nothing rings but what the gearbox itself excites.
"""

import re
import zipfile
from pathlib import Path

import herringbone as hb
from herringbone.running.prepared import Wishes, prepared
from support.foreign.strangers import write_system

TORQUE = 200.0
"""At the pinion [N m]."""
MOTOR_SHAFT, SIDE_SHAFT, RADIUS = 8e4, 1.2e4, 0.31
FLANGE = re.compile(r"\.(phi|w)$")


class Gearbox:
    """Start values of steady rotation at `rpm` of the pinion [1/min]."""

    def __init__(self, rpm: float, folder: Path) -> None:
        self.rpm = rpm
        cycle = folder / f"steady_{rpm:g}.csv"
        cycle.write_text(
            f"# units: time s, speed r/min, torque N.m\ntime,speed,torque\n0.0,{rpm},{TORQUE}\n",
            encoding="utf-8",
        )
        wishes = Wishes(values={"bench_controller.cycle": str(cycle)})
        system = prepared("test_rig", None, wishes).system
        self.values = {
            f"{part.name}.{name}": value
            for part in system.parts
            for name, value in part.values.items()
            if isinstance(value, float) and part.name.endswith(("gear_mesh", "modal_housing"))
        }
        alone = {path.removeprefix("gearbox."): value for path, value in self.values.items()}
        run = hb.run(
            "gearbox", algorithm="jacobi:order=0", step=1e-6, t_end=2e-6, record_step=1e-6,
            start="rest", values=alone,
        )  # fmt: skip
        self.flange = {
            (gear, quantity): float(run.data[f"gear_mesh.{gear}.{quantity}"].iloc[0])
            for gear in ("pinion", "wheel")
            for quantity in ("phi", "w")
        }

    def motor(self, gear: str = "pinion") -> dict[str, str]:
        """What the script of an e-motor at a gear begins with, instead of what."""
        phi, w = self.flange[gear, "phi"], self.flange[gear, "w"]
        torque = self.torque(gear)
        return {
            "self.x = [0.0, 0.0, 0.0]": f"self.x = [{torque}, {torque / MOTOR_SHAFT + phi}, {w}]",
            "phi=0.0, w=0.0": f"phi={phi}, w={w}",
        }

    def torque(self, gear: str) -> float:
        """On the gearbox at the flange of a gear [N m]."""
        wheel = -TORQUE * self.flange["pinion", "w"] / self.flange["wheel", "w"]
        return TORQUE if gear == "pinion" else wheel

    def vehicle(self) -> dict[str, str]:
        """What the script of the vehicle begins with, instead of what."""
        phi, w = self.flange["wheel", "phi"], self.flange["wheel", "w"]
        angle, speed = phi + self.torque("wheel") / SIDE_SHAFT, RADIUS * w
        return {
            "self.angle = self.speed = 0.0": f"self.angle = {angle}; self.speed = {speed}",
            "phi=0.0, w=0.0": f"phi={phi}, w={w}",
        }


def with_motors(file: Path, folder: Path, rpm: float) -> tuple[Path, dict[str, float]]:
    """A gearbox with e-motors at both flanges in steady rotation, and what is to be set in it.

    Args:
        file: FMU of the e-motor.
        folder: to write into.
        rpm: of the pinion [1/min].
    """
    gearbox = Gearbox(rpm, folder)
    files, values = {}, dict(gearbox.values)
    for part, gear in (("drive", "pinion"), ("brake", "wheel")):
        to = folder / f"{part}_at_{rpm:.0f}.fmu"
        files[part] = changed(file, to, gearbox.motor(gear), plain=False, declared=True)
        values[f"{part}.torque_set"] = gearbox.torque(gear)
    joined = [["drive.flange", "gearbox.pinion"], ["brake.flange", "gearbox.wheel"]]
    system = write_system(folder, f"motors_at_{rpm:.0f}", joined, files)
    with (system / "system.toml").open("a", encoding="utf-8") as opened:
        opened.write('\ngearbox = { system = "gearbox" }\n')
    return system, values


def changed(file: Path, to: Path, script: dict[str, str], *, plain: bool, declared: bool) -> Path:
    """A copy of an FMU of pythonfmu.

    Args:
        file: the FMU.
        to: the copy.
        script: text of its script, and what stands there instead.
        plain: without saving and restoring its state.
        declared: with the inputs that pass directly to its torque; else nothing is declared.
    """
    with zipfile.ZipFile(file) as whole, zipfile.ZipFile(to, "w") as copy:
        module = whole.read("resources/slavemodule.txt").decode().strip()
        for entry in whole.namelist():
            name, data = entry, whole.read(entry)
            if name == f"resources/{module}.py":
                text = data.decode()
                for old, new in script.items():
                    assert old in text
                    text = text.replace(old, new)
                name, data = f"resources/{to.stem}.py", text.encode()
            elif name == "resources/slavemodule.txt":  # Python keeps modules by their names
                data = to.stem.encode()
            elif name == "modelDescription.xml":
                data = _described(data.decode(), plain=plain, declared=declared).encode()
            copy.writestr(name, data)
    return to


def _described(text: str, *, plain: bool, declared: bool) -> str:
    if plain:
        for ability in ("canGetAndSetFMUstate", "canSerializeFMUstate"):
            text = text.replace(f'{ability}="true"', f'{ability}="false"')
    begin, end = text.index("<Outputs>"), text.index("</Outputs>")
    outputs = re.sub(r' dependencies="[^"]*"', "", text[begin:end])
    if declared:
        names = re.findall(r'<ScalarVariable name="([^"]*)"', text)
        motions = " ".join(str(i) for i, name in enumerate(names, 1) if FLANGE.search(name))
        for i, name in enumerate(names, 1):
            passed = motions if name.endswith(".tau") else ""
            outputs = outputs.replace(f'index="{i}"', f'index="{i}" dependencies="{passed}"')
    return text[:begin] + outputs + text[end:]

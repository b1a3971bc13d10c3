"""Gear, bearings and housing coupled by plain fmpy, in equilibrium from the start."""

from fmpy import extract, instantiate_fmu, read_model_description

import herringbone as hb

SPEED, TORQUE, STEP = 104.72, 200.0, 2e-6  # pinion [rad/s, N m], communication step [s]


def main(t_end: float = 0.002) -> float:
    """Sum of the forces that the bearings put on the pinion along the line of action [N]."""
    start, links = hb.start_values("gearbox", speed=SPEED, torque=TORQUE), hb.connections("gearbox")
    slaves, vr = {}, {}
    for name, file in zip(start, hb.build_fmus(start, native=True), strict=True):
        model = read_model_description(file)
        vr[name] = {v.name: [v.valueReference] for v in model.modelVariables}
        slaves[name] = instantiate_fmu(extract(file), model, "CoSimulation")
        for variable, value in start[name].items():
            slave, reference = slaves[name], vr[name][variable]
            (slave.setString if isinstance(value, str) else slave.setReal)(reference, [value])
        slaves[name].enterInitializationMode()
    for _ in range(2):
        for source, output, target, into in links:
            slaves[target].setReal(vr[target][into], slaves[source].getReal(vr[source][output]))
    [slave.exitInitializationMode() for slave in slaves.values()]
    for n in range(round(t_end / STEP)):
        values = [slaves[source].getReal(vr[source][output]) for source, output, _, _ in links]
        for (_, _, target, into), value in zip(links, values, strict=True):
            slaves[target].setReal(vr[target][into], value)
        [slave.doStep(n * STEP, STEP) for slave in slaves.values()]
    forces = [vr["bearing_supports"][f"shaft.pinion_{side}.f_y"][0] for side in ("left", "right")]
    return sum(slaves["bearing_supports"].getReal(forces))


if __name__ == "__main__":
    print(f"bearings on the pinion: {main():.1f} N")

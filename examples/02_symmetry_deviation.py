"""Symmetry deviation f_A of the chevron's apex: axial vibration of the floating pinion."""

import herringbone as hb


def main(t_end: float = 0.18) -> float:
    """Axial rms velocity of the pinion per micrometre of f_A, over a wheel turn [mm/s per um]."""
    velocity = {}
    for micrometres in (0.0, 10.0, 20.0):
        result = hb.run(
            "test_rig",
            t_end=t_end,
            fmu="in-process",
            values={"gear_mesh.symmetry_deviation": micrometres * 1e-6},
        )
        left, right = (result[f"gear_mesh.pinion_{side}.v_z"] for side in ("left", "right"))
        velocity[micrometres] = 1e3 * float((0.5 * (left + right)).std())
        print(f"f_A = {micrometres:4.0f} um: pinion {velocity[micrometres]:.4f} mm/s rms")
    return velocity[20.0] / 20.0


if __name__ == "__main__":
    main()

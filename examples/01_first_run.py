"""First run: the test rig at 1000 r/min and 200 N m; the dynamic bearing force of the pinion."""

import herringbone as hb


def main(t_end: float = 0.2) -> float:
    """Run the rig; returns the rms of the alternating bearing force [N]."""
    result = hb.run("test_rig", t_end=t_end)
    force = result["bearing_supports.shaft.pinion_left.f_y"]
    rms = float(force.std())
    print(f"pinion left: mean {force.mean():.1f} N, alternating {rms:.2f} N rms")
    result.plot().savefig("test_rig.png")
    return rms


if __name__ == "__main__":
    main()

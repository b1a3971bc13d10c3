"""Error against step: each order of extrapolation, against the monolithic twin."""

import herringbone as hb

STEPS = (20e-6, 10e-6, 5e-6, 2.5e-6)


def main(t_end: float = 0.02) -> float:
    """Prints the table; returns the error of order 2 at 10 us [1]."""
    found = {}
    print("step [us] " + "".join(f"  order {order}" for order in (0, 1, 2)))
    for step in STEPS:
        for order in (0, 1, 2):
            result = hb.run(
                "test_rig",
                t_end=t_end,
                step=step,
                algorithm=hb.Jacobi(order=order),
                fmu="in-process",
                reference=True,
            )
            found[step, order] = result.error["bearing_force"]
        errors = "".join(f"  {100 * found[step, order]:6.3f}%" for order in (0, 1, 2))
        print(f"{1e6 * step:9.1f} {errors}")
    return found[10e-6, 2]


if __name__ == "__main__":
    main()

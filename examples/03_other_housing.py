"""Another housing: the thesis' four modes instead of the calibrated housing."""

import herringbone as hb

THESIS = {
    "modal_housing.modes": "thesis_modes.csv",
    "modal_housing.shapes": "thesis_shapes.csv",
}


def main(t_end: float = 0.1) -> float:
    """Seat velocity of the thesis' modes as a share of that of the full housing (rms)."""
    rms = []
    for values in ({}, THESIS):
        result = hb.run("test_rig", t_end=t_end, values=values)
        rms.append(float((result.data[result.channel("seat_velocity")] ** 2).mean().mean() ** 0.5))
    print(f"seat velocity: full {1e3 * rms[0]:.4f} mm/s, thesis' modes {1e3 * rms[1]:.4f} mm/s rms")
    return rms[1] / rms[0]


if __name__ == "__main__":
    main()

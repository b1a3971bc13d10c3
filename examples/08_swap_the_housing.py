"""Swap the housing: other modal data, or any FMU that holds the contract of housings.

python examples/08_swap_the_housing.py [DATA ...] [HOUSING.fmu ...]

DATA is a folder of the format modal-housing, as `herringbone housing build`, `reduce` and `import`
write it; it should be good up to the highest line that is looked at, here 1350 Hz, the third mesh
harmonic. An FMU is tested first; see `herringbone check HOUSING.fmu --as housing`.
"""

import sys
import tempfile
from pathlib import Path

import herringbone as hb
from herringbone.housing import default_housing, write_housing
from herringbone.housing.reduction.reduced_housing import reduce_housing


def main(t_end: float = 0.05, others: tuple[str, ...] = ()) -> dict[str, float]:
    """How far seat velocities are from those with the default housing, over their alternation."""
    with tempfile.TemporaryDirectory() as folder:
        small = reduce_housing(default_housing(), band_hz=1500.0, tolerance=0.05)
        reduced = Path(folder, "reduced_to_1500_Hz")
        write_housing(small, reduced)
        full, found = hb.run("test_rig", t_end=t_end), {}
        for housing in (reduced, *map(Path, others)):
            result = hb.run("test_rig", t_end=t_end, housing=housing)
            columns = result.channel("seat_velocity")
            ours, theirs = (each.data[columns] for each in (result, full))
            off, size = ((ours - theirs) ** 2).mean(), theirs.var(ddof=0)
            found[housing.stem] = float((off.sum() / size.sum()) ** 0.5)
            single = (off / size) ** 0.5
            levels = " and ".join(
                f"{1e3 * float((data**2).mean().mean() ** 0.5):.4f}" for data in (ours, theirs)
            )
            print(
                f"{housing.stem}: {100 * found[housing.stem]:.1f} % off over time, worst seat "
                f"{single.idxmax()}: {100 * single.max():.0f} %; levels: {levels} mm/s"
            )
            for note in result.info.notes:
                if "housings" in note:
                    print(f"  {note}")
    return found


if __name__ == "__main__":
    main(others=tuple(sys.argv[1:]))

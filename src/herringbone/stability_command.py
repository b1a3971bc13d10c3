"""The command `stability`: predict the stable steps of algorithms on a scene."""

import argparse
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

from tqdm import tqdm

from herringbone.output import check_writable


def stability(options: argparse.Namespace, values: Mapping[str, float | str]) -> str:
    """Predict; returns the table, or one JSON object.

    Raises:
        HerringboneError: something about the options is wrong, or a file cannot be written.
    """
    from herringbone import api, start  # noqa: PLC0415 (numba: only when something runs)
    from herringbone.analysis import stability_report as report  # noqa: PLC0415
    from herringbone.analysis.atlas import atlas  # noqa: PLC0415
    from herringbone.analysis.stability import stability as predict  # noqa: PLC0415
    from herringbone.cosim.algorithms import parse_algorithm, refuse_adaptive  # noqa: PLC0415
    from herringbone.scenes import Start  # noqa: PLC0415

    output = options.output or (Path("results") if options.atlas else None)
    if output:
        check_writable(output)
    algorithms = [parse_algorithm(text) for text in options.algorithm or ()]
    refuse_adaptive(algorithms, "stability is predicted for fixed steps")
    structure, folder = api.load_system(options.system)
    scene = api.load_scene(folder, options.scene)
    scene = replace(
        scene, start=Start.EQUILIBRIUM, start_offset={}, values={**scene.values, **values}
    )
    structure, _ = start.started(structure, scene)
    with tqdm(unit=" matrices", disable=None) as bar:

        def progress(algorithm: str) -> None:
            bar.set_description(algorithm, refresh=False)
            bar.update()

        found = predict(
            structure, scene.name, algorithms, tolerance=options.tolerance, progress=progress
        )
        panels = atlas(structure, progress=progress) if options.atlas else ()
    if output:
        report.write_stability(found, output)
    if panels:
        from herringbone.plotting.stability_atlas import atlas_picture  # noqa: PLC0415

        atlas_picture(panels).savefig(output / "stability_atlas.png")
    return report.stability_json(found) if options.json else report.stability_text(found)

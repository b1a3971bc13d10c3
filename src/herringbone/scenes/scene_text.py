"""A scene as the text of a file."""

import json
from pathlib import Path

from herringbone.scenes.asking_text import asking_text
from herringbone.scenes.scene import Scene


def scene_text(scene: Scene) -> str:
    """A scene as `read_scene` takes it, whatever folder it is in."""
    lines = [
        f"description = {json.dumps(scene.description, ensure_ascii=False)}",
        f"t_end = {scene.t_end!r}",
        f"record_step = {scene.record_step!r}",
        f'start = "{scene.start}"',
    ]
    files = {"gear": scene.gears, "housing": scene.housings}
    tables: dict[str, dict] = {name: dict(given) for name, given in files.items() if given}
    tables |= {"set": dict(scene.values), "start_offset": dict(scene.start_offset)}
    for name, table in tables.items():
        if table:
            lines += ["", f"[{name}]"]
        for key, value in table.items():
            text = value if isinstance(value, int | float) else json.dumps(_whole(value))
            lines.append(f"{json.dumps(key)} = {text}")
    lines += asking_text(scene.asks, scene.operating, scene.model)
    return "\n".join(lines) + "\n"


def _whole(value: str | Path) -> str:
    return str(value.absolute()) if isinstance(value, Path) else value

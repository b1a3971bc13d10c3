"""Scenes: what is run on a system, and what is asked of it."""

from herringbone.scenes.asking import Ask, Model, Motion, Operating
from herringbone.scenes.scene import Scene, Start, find_scene, read_scene

__all__ = [
    "Ask",
    "Model",
    "Motion",
    "Operating",
    "Scene",
    "Start",
    "find_scene",
    "read_scene",
]

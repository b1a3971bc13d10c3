"""Scenes: what is run on a system."""

from herringbone.scenes.scene import Scene, Start, find_scene, read_scene

__all__ = ["Scene", "Start", "find_scene", "read_scene"]

"""Pictures of a gear pair and of the load on its flanks."""

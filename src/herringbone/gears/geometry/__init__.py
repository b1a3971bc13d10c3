"""Geometry of a gear pair: involutes, teeth, contact, modifications, masses."""

"""The parametric welded housing: dimensions, mesh, finite elements, shipped data."""

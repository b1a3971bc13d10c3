"""FMI co-simulation components for herringbone gearboxes."""

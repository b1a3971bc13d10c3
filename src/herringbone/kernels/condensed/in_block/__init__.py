"""The condensed core inside of a component: its form, and its steps, in the kernel language."""

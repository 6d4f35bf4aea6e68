"""Time integrators of a released scene; each advances a ``Motion`` on a uniform grid of records."""

"""The kernels of the sequential impulse solver, compiled."""

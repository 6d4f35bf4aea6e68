"""Studies of the sequential impulse solver."""

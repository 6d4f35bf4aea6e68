"""A mechanism in three coordinates a body, its strips condensed to their ends, and its equilibrium paths."""

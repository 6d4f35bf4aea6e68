"""A mechanism in reduced coordinates: three a body, the strips condensed to their ends; its equilibrium paths."""

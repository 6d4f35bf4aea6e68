"""Motion on reduced coordinates: clamps hold by construction, over a step as in a state."""

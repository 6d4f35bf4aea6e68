"""Effects that a scene names beside bending and stretching: values, loads, natural strains, damping."""

"""DESIGNS.toml: what it may say, how it is read, and the points that follow from it."""

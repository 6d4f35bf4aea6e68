"""The interactive augmented-reality design environment of the paper's section 4."""

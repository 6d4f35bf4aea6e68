"""The interactive augmented-reality design environment of the paper's section 4: designs to start from, their
mechanics held and released, and the session that drives them."""

"""The pivot at work: designs to start from, their mechanics held and released, and the session that drives
them."""

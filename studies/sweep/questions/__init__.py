"""Questions that a sweep answers: the studies of the group."""
